"""Join edges given in any order into chains of vertices, closed or open."""

from collections.abc import Sequence
from dataclasses import dataclass

from .source import Source


@dataclass(frozen=True, slots=True)
class Link:
    """An edge between two vertices (indices from 0), and the line that says so."""

    tail: int
    head: int
    line: int


@dataclass(frozen=True, slots=True)
class Chain:
    """Indices of the vertices of a polygon, and whether an edge leads from the last to the first."""

    vertices: list[int]
    closed: bool


def chains(source: Source, links: Sequence[Link]) -> list[Chain]:
    """Join edges into chains of vertex indices.

    Each closed chain starts at its smallest index and follows the direction of the edges there, so a file that lists
    its polygon in order keeps that order. An open chain starts at the end with the smaller index.

    Raises
    ------
    CurveFileError
        If an edge joins a vertex to itself, or more than two edges meet.
    """
    at = _links_at_vertices(source, links)
    ends = [vertex for vertex in sorted(at) if len(at[vertex]) == 1]
    found = []
    done: set[int] = set()
    for vertex in ends + sorted(at):
        if vertex not in done:
            chain = _walk(at, vertex)
            done.update(chain)
            found.append(Chain(chain, closed=len(at[vertex]) == 2))
    return sorted(found, key=lambda chain: min(chain.vertices))


def _links_at_vertices(source: Source, links: Sequence[Link]) -> dict[int, list[Link]]:
    at: dict[int, list[Link]] = {}
    for link in links:
        if link.tail == link.head:
            raise source.error(f"an edge joins vertex {link.tail + 1} to itself", link.line)
        for vertex in (link.tail, link.head):
            at.setdefault(vertex, []).append(link)
            if len(at[vertex]) > 2:
                reason = f"a third edge meets vertex {vertex + 1}; curves don't branch, and edges are given once"
                raise source.error(reason, link.line)
    return at


def _walk(at: dict[int, list[Link]], start: int) -> list[int]:
    """Follow the chain from a vertex to its end or round to the start."""
    link = min(at[start], key=lambda link: (link.tail != start, link.head + link.tail))
    chain = [start]
    vertex = _other_end(link, start)
    while vertex != start:
        chain.append(vertex)
        onward = [other for other in at[vertex] if other is not link]
        if not onward:
            break
        link = onward[0]
        vertex = _other_end(link, vertex)
    return chain


def _other_end(link: Link, vertex: int) -> int:
    return link.head if link.tail == vertex else link.tail
