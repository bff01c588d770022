"""Crossings that join two parts of a diagram and nothing else: turning one part over undoes them."""

from .diagram import Diagram
from .faces import Faces


def without_nugatory(diagram: Diagram) -> Diagram:
    """The diagram without nugatory crossings: where one region meets itself.

    Leaving one out of the code makes a connected sum, in one component, of the two parts, which is what it was.
    """
    while found := _nugatory(diagram):
        diagram = diagram.without(found)
    return diagram


def _nugatory(diagram: Diagram) -> set[int]:
    faces, found = Faces(diagram), set()
    for crossing, (lower, _) in enumerate(diagram.strands):
        before = diagram.previous[lower]
        if faces.right[before] == faces.left[lower] or faces.left[before] == faces.right[lower]:
            found.add(crossing)
    return found
