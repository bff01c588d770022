"""Figures as files: SVG, PDF and TikZ, all text but for PDF's compression."""

import re
import zlib
from collections.abc import Callable, Iterator, Mapping
from itertools import groupby
from xml.sax.saxutils import escape

from ..base import FloatArray
from .figure import Figure

_SPECIAL = re.compile(r"[#$%&_{}^~\\]")  # to TeX
_MATHS = str.maketrans({"<": "$<$", ">": "$>$", "|": "$|$", "⊔": "$\\sqcup$"})  # what its fonts of texts lack
_SUBSCRIPT = re.compile(r"_(\d+)")


def svg(figure: Figure) -> bytes:
    """Scalable Vector Graphics, in points."""
    width, height = figure.size

    def path(points: FloatArray, curved: bool) -> str:
        xy = [f"{_number(x)} {_number(height - y)}" for x, y in points.tolist()]
        return f"M{xy[0]}{'C' if curved else 'L'}{' '.join(xy[1:])}"

    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_number(width)}pt" height="{_number(height)}pt" '
        f'viewBox="0 0 {_number(width)} {_number(height)}">'
    ]
    dashes = f' stroke-dasharray="{" ".join(map(_number, figure.dashes))}"' if figure.dashes else ""
    for (thick, colour), strokes in groupby(figure.strokes, lambda stroke: (stroke.width, stroke.colour)):
        pen = f'stroke="{colour}" stroke-width="{_number(thick)}"{dashes}'
        lines.append(f'<g fill="none" stroke-linecap="round" stroke-linejoin="round" {pen}>')
        lines += [f'<path d="{path(stroke.controls, True)}"/>' for stroke in strokes]
        lines.append("</g>")
    lines += [f'<path fill="{head.colour}" d="{path(head.points, False)}Z"/>' for head in figure.heads]
    for label in figure.labels:
        x, y = label.place
        text, shift = "", 0.0
        for part, low in _parts(label.text):
            down, shift = 0.25 * label.height * low - shift, 0.25 * label.height * low
            size = _number(label.height * (0.7 if low else 1.0))
            text += f'<tspan dy="{_number(down)}" font-size="{size}">{escape(part)}</tspan>'
        place = f'x="{_number(x)}" y="{_number(height - y + 0.33 * label.height)}"'
        lines.append(f'<text {place} text-anchor="middle" font-family="Times, serif">{text}</text>')
    return "\n".join([*lines, "</svg>", ""]).encode()


def tikz(figure: Figure) -> bytes:
    """A picture for LaTeX with the package tikz, in big points."""
    lines = ["% \\usepackage{tikz}", "\\begin{tikzpicture}[x=1bp, y=1bp, line cap=round, line join=round]"]

    def colour(code: str) -> str:
        red, green, blue = _rgb(code)
        return f"{{rgb,1:red,{red:.3f};green,{green:.3f};blue,{blue:.3f}}}"

    on_off = [f"{word} {_number(length)}bp" for word, length in zip(("on", "off"), figure.dashes, strict=False)]
    dashes = f", dash pattern={' '.join(on_off)}" if figure.dashes else ""
    for stroke in figure.strokes:
        p = [f"({_number(x)},{_number(y)})" for x, y in stroke.controls.tolist()]
        curves = "".join(f"\n  .. controls {p[k]} and {p[k + 1]} .. {p[k + 2]}" for k in range(1, len(p), 3))
        lines.append(
            f"\\draw[color={colour(stroke.colour)}, line width={_number(stroke.width)}bp{dashes}] {p[0]}{curves};"
        )
    for head in figure.heads:
        corners = " -- ".join(f"({_number(x)},{_number(y)})" for x, y in head.points.tolist())
        lines.append(f"\\fill[color={colour(head.colour)}] {corners} -- cycle;")
    for label in figure.labels:
        words = [
            f"$_{{{part}}}$" if low else _SPECIAL.sub(r"\\char`\\\g<0>{}", part).translate(_MATHS)
            for part, low in _parts(label.text)
        ]
        size = f"\\fontsize{{{_number(label.height)}bp}}{{{_number(label.height)}bp}}\\selectfont"
        lines.append(f"\\node at ({_number(label.place[0])},{_number(label.place[1])}) {{{size} {''.join(words)}}};")
    return "\n".join([*lines, "\\end{tikzpicture}", ""]).encode()


def pdf(figure: Figure) -> bytes:
    """A page of the Portable Document Format (ISO 32000, sections 7 to 9)."""

    def path(points: FloatArray, curved: bool) -> str:
        xy = [f"{_number(x)} {_number(y)}" for x, y in points.tolist()]
        step, mark = (3, "c") if curved else (1, "l")
        return "\n".join([f"{xy[0]} m", *(f"{' '.join(xy[k : k + step])} {mark}" for k in range(1, len(xy), step))])

    def colour(code: str) -> str:
        return " ".join(f"{each:.3f}" for each in _rgb(code))

    drawn = [f"1 J 1 j [{' '.join(map(_number, figure.dashes))}] 0 d"]
    for stroke in figure.strokes:
        drawn += [f"{colour(stroke.colour)} RG {_number(stroke.width)} w", path(stroke.controls, True), "S"]
    for head in figure.heads:
        drawn += [f"{colour(head.colour)} rg", path(head.points, False), "f"]
    drawn.append("0 g")
    for label in figure.labels:
        parts = [(part, low, label.height * (0.7 if low else 1.0)) for part, low in _parts(label.text)]
        x = label.place[0] - 0.25 * sum(len(part) * size for part, _, size in parts)  # digits are half an em wide
        drawn.append(f"BT {_number(x)} {_number(label.place[1] - 0.33 * label.height)} Td")
        for part, low, size in parts:
            text = part.encode("cp1252", "replace").hex()
            drawn.append(f"/F {_number(size)} Tf {_number(-0.25 * label.height * low)} Ts <{text}> Tj")
        drawn.append("ET")
    content = zlib.compress("\n".join(drawn).encode())
    font = "<< /Type /Font /Subtype /Type1 /BaseFont /Times-Roman /Encoding /WinAnsiEncoding >>"
    box = " ".join(map(_number, figure.size))
    objects = [
        b"<< /Type /Catalog /Pages 2 0 R >>",
        b"<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
        f"<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {box}] /Contents 4 0 R "
        f"/Resources << /Font << /F {font} >> >> >>".encode(),
        f"<< /Length {len(content)} /Filter /FlateDecode >>\nstream\n".encode() + content + b"\nendstream",
    ]
    file, places = b"%PDF-1.4\n", list[int]()
    for number, each in enumerate(objects, start=1):
        places.append(len(file))
        file += b"%d 0 obj\n%b\nendobj\n" % (number, each)
    table = b"".join(b"%010d 00000 n \n" % place for place in places)
    count = len(objects) + 1
    end = b"trailer << /Size %d /Root 1 0 R >>\nstartxref\n%d\n%%%%EOF\n" % (count, len(file))
    return file + b"xref\n0 %d\n0000000000 65535 f \n" % count + table + end


PAPERS: Mapping[str, Callable[[Figure], bytes]] = {".svg": svg, ".pdf": pdf, ".tex": tikz}
"""What makes a file of a figure, by suffix."""


def _number(value: float) -> str:
    return f"{value:.2f}".rstrip("0").rstrip(".")


def _rgb(code: str) -> tuple[float, ...]:
    return tuple(int(code[k : k + 2], 16) / 255 for k in (1, 3, 5))


def _parts(text: str) -> Iterator[tuple[str, bool]]:
    """The pieces of a text, and whether each is a subscript, as is a number after an underscore."""
    for k, part in enumerate(_SUBSCRIPT.split(text)):
        if part:
            yield part, k % 2 == 1
