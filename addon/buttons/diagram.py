"""The operator that draws a diagram of curves as a file for papers."""

from pathlib import Path

import bpy
from bpy.props import BoolProperty, StringProperty

from ...core import MobiusFlowError
from ...core.base import Message, write_file
from ...core.keys.arcs import seen
from ...core.keys.figure import Pen, figure
from ...core.keys.paper import PAPERS
from ..curves.recorded import Recorded, in_world
from ..live.requirements import READABLE, selected_curves
from ..translations import rpt_
from .button import Button


class CURVE_OT_mobius_flow_draw_diagram(Button, bpy.types.Operator):
    """Draw the selected curves as knots are drawn on paper, from where the fewest strands cross, \
as they are at the end of their animation"""

    bl_label = "Draw Diagram"
    bl_options = {"REGISTER"}
    needs = (READABLE,)

    filepath: StringProperty(name="File", description="Where the drawing goes: SVG, PDF or, with .tex, TikZ")
    arrows: BoolProperty(name="Arrows", description="Show the directions of the curves")
    numbers: BoolProperty(name="Numbers", description="Number the crossings")

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        self.filepath = self.filepath or f"{context.object.name}.svg"
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def act(self, context: bpy.types.Context) -> None:
        path = Path(bpy.path.abspath(self.filepath))
        if (paper := PAPERS.get(path.suffix.lower())) is None:
            raise MobiusFlowError(
                Message("Drawings are .svg, .pdf or .tex; give '{name}' one of these", name=path.name)
            )
        objects = selected_curves(context)
        recorded = [Recorded.of(obj) for obj in objects]
        link = in_world(objects, recorded, [each.points[-1] for each in recorded])
        write_file(path, paper(figure(seen([link]), pen=Pen(arrows=self.arrows, numbers=self.numbers))))
        self.report({"INFO"}, rpt_("Drawn: {path}", path=path))
