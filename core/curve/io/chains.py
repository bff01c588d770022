"""Join edges given in any order into closed chains of vertices."""

from collections.abc import Sequence
from dataclasses import dataclass

from .source import Source


@dataclass(frozen=True, slots=True)
class Link:
    """An edge between two vertices (indices from 0), and the line that says so."""

    tail: int
    head: int
    line: int


def closed_chains(source: Source, links: Sequence[Link], points: Sequence[Sequence[float]]) -> list[list[int]]:
    """Join edges into closed chains of vertex indices.

    Each chain starts at its smallest index and follows the direction of the edges there, so a file that
    lists its polygon in order keeps that order. A chain whose two ends lie at the same point is closed; it
    keeps both vertices.

    Raises
    ------
    CurveFileError
        If an edge joins a vertex to itself, more than two edges meet, or a chain is open.
    """
    at = _links_at_vertices(source, links)
    ends = [vertex for vertex in sorted(at) if len(at[vertex]) == 1]
    chains = []
    done: set[int] = set()
    for vertex in ends + sorted(at):
        if vertex not in done:
            chain = _walk(at, vertex)
            if len(at[vertex]) == 1:
                _check_ends_meet(source, at, chain, points)
            done.update(chain)
            chains.append(chain)
    return sorted(chains, key=min)


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


def _check_ends_meet(
    source: Source, at: dict[int, list[Link]], chain: list[int], points: Sequence[Sequence[float]]
) -> None:
    if points[chain[0]] != points[chain[-1]]:
        reason = (
            f"the polyline from vertex {chain[0] + 1} to vertex {chain[-1] + 1} is open; "
            f"only closed polygons can be used, so add the edge 'l {chain[-1] + 1} {chain[0] + 1}'"
        )
        raise source.error(reason, at[chain[-1]][0].line)
