"""Every text of the extension has its German, and nothing is shown that could not be said in another language."""

import ast
import re
from string import Formatter
from types import SimpleNamespace

import pytest

bpy = pytest.importorskip("bpy")

import shown_texts  # noqa: E402
from mobius_flow.addon import registration, translations  # noqa: E402
from mobius_flow.addon.curves.turned import lay_flat  # noqa: E402
from mobius_flow.addon.engine.phrase import Phrase  # noqa: E402
from mobius_flow.addon.engine.words import named  # noqa: E402
from mobius_flow.addon.pictures.filming import target  # noqa: E402
from mobius_flow.core import MobiusFlowError  # noqa: E402

LANGUAGES = translations.LANGUAGES
MODULES = sorted(shown_texts.ADDON.rglob("*.py"))


def tables():
    return [(code, kind) for code in LANGUAGES for kind in ("LABELS", "TOOLTIPS", "SENTENCES")]


@pytest.fixture
def shown():
    labels = shown_texts.labels()
    return {
        "LABELS": labels,
        "TOOLTIPS": shown_texts.tooltips(),
        "SENTENCES": shown_texts.sentences() - labels,
    }


@pytest.mark.parametrize(("code", "kind"), tables())
def test_every_text_is_translated_and_none_that_is_no_more(shown, code, kind):
    table = getattr(LANGUAGES[code], kind)
    assert {"missing": sorted(shown[kind] - set(table)), "stale": sorted(set(table) - shown[kind])} == {
        "missing": [],
        "stale": [],
    }


@pytest.mark.parametrize(("code", "kind"), tables())
def test_fields_stay_what_they_are(code, kind):
    for text, said in getattr(LANGUAGES[code], kind).items():
        if kind == "SENTENCES":
            assert fields(said) == fields(text), text
        assert said.strip() == said
        assert said[-1] == "." or text[-1] != ".", text


def fields(template):
    return sorted((name, spec) for _, name, spec, _ in Formatter().parse(template) if name is not None)


def test_german_addresses_nobody():
    said = [text for kind in ("LABELS", "TOOLTIPS", "SENTENCES") for text in getattr(LANGUAGES["de"], kind).values()]
    assert not [text for text in said if re.search(r"\b([Dd]u|[Dd]ein\w*|Ihr\w*|[Bb]itte)\b|\w+en Sie\b", text)]


@pytest.mark.parametrize("path", MODULES, ids=lambda path: str(path.relative_to(shown_texts.ADDON)))
def test_nothing_is_shown_as_it_is(path):
    assert not list(shown_texts.unmarked(path))


@pytest.mark.parametrize(
    "line",
    [
        "self.report({'ERROR'}, 'No')",
        "self.report({'ERROR'}, str(error))",
        "cls.poll_message_set(reason)",
        "Refusal('No')",
        "Phrase(f'{name} is closed')",
        "layout.label(text=f'Add {name}')",
        "sentence(layout, context, f'{name} is open')",
        "manager.invoke_confirm(self, event, message=f'{name} is there already')",
    ],
)
def test_what_is_not_marked_is_found(tmp_path, line):
    path = tmp_path / "module.py"
    path.write_text(f"\n{line}\n")
    assert set(shown_texts.unmarked(path)) == {2}


def test_sentences_are_found_wherever_they_are_made(tmp_path):
    path = tmp_path / "module.py"
    path.write_text(
        "A, b = 'One', 1\nsaid = 'Two'\nPhrase(A)\nrpt_(said if b else 'Three')\nvalue(box, 'Four', 'five')\n"
        "layout.operator('mesh.six', text='Seven')\nlayout.label(text='…')\nprint('eight')\n"
    )
    assert shown_texts.sentences(path) == {"One", "Two", "Three", "Four", "Seven"}


def test_names_have_our_context_and_blenders_own_properties_do_not():
    pick = bpy.ops.curve.mobius_flow_pick_knot.get_rna_type()
    assert pick.translation_context == pick.properties["knot"].translation_context == translations.CONTEXT
    assert pick.properties["align"].translation_context == bpy.app.translations.contexts.default
    for cls in registration._CLASSES:
        if not issubclass(cls, bpy.types.PropertyGroup):
            assert getattr(bpy.types, cls.__name__).bl_rna.translation_context == translations.CONTEXT


def test_blender_is_told_the_tables_and_to_forget_them(monkeypatch):
    told = {}
    monkeypatch.setattr(translations, "translations", SimpleNamespace(register=told.__setitem__, unregister=told.pop))
    translations.register()
    table = told["mobius_flow.addon.translations"]["de"]
    assert table[translations.CONTEXT, "Links"] == "Verschlingungen"
    assert table["*", "What stays"] == "Was bleibt"
    assert len(table) == sum(len(getattr(LANGUAGES["de"], kind)) for kind in ("LABELS", "TOOLTIPS", "SENTENCES"))
    translations.unregister()
    assert not told


@pytest.mark.skipif(not bpy.app.build_options.international, reason="this Blender speaks English only")
def test_blender_speaks_german():
    view = bpy.context.preferences.view
    view.language, view.use_translate_interface = "de_DE", True
    assert translations.iface_("Links") == "Verschlingungen"


def german(text):
    return {**LANGUAGES["de"].LABELS, **LANGUAGES["de"].SENTENCES}[text]


def test_a_refusal_in_german():
    bpy.ops.curve.mobius_flow_add_knot(knot="3_1")
    curve = bpy.context.active_object
    curve.name, curve.data.dimensions = "{Knot}", "2D"
    with pytest.raises(RuntimeError, match=r"'\{Knot\}' is a 2D curve"):
        bpy.ops.curve.mobius_flow_relax()
    from mobius_flow.addon.live.checks import refusal

    said = refusal(bpy.context).sentence.said(german)
    assert said.startswith("'{Knot}' ist eine 2D-Kurve")


def test_what_cannot_be_turned_in_german():
    bpy.ops.curve.mobius_flow_add_knot(knot="3_1")
    curve = bpy.context.active_object
    curve.name = "Knot"
    curve.constraints.new("LIMIT_LOCATION")
    with pytest.raises(MobiusFlowError) as caught:
        lay_flat([curve])
    said = str(caught.value).said(german)
    assert said == "'Knot' wird bewegt (Beschränkung); das entfernen oder die Kurve backen und einzeln drehen"


def test_what_is_no_film_in_german(tmp_path):
    with pytest.raises(MobiusFlowError) as caught:
        target(str(tmp_path))
    assert str(caught.value).said(german) == f"{tmp_path} ist ein Verzeichnis; eine Datei darin angeben"


def test_names_are_joined_in_german():
    assert named(["A", "B", "C"]).said(german) == "'A', 'B' und 'C'"
    assert named("ABCDEF").said(german) == "'A', 'B', 'C' und 3 weitere"


def test_errors_hand_phrases_on():
    phrase = Phrase("{names} is being relaxed; stop that first", names=named(["A", "B"]))
    said = str(MobiusFlowError(phrase)).said(german)
    assert said == "'A' und 'B': Entspannung läuft; diese zuerst beenden"


def test_what_nobody_has_translated_stays_as_it_is():
    for text in ("a sentence of the core, {with braces}", "5_2"):
        assert translations.rpt_(text) == translations.iface_(text) == translations.tip_(text) == text


def test_the_tables_are_written_once():
    """A key that is there twice would silently win."""
    for path in sorted((shown_texts.ADDON / "translations").rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            keys = [key.value for key in getattr(node, "keys", []) if isinstance(key, ast.Constant)]
            assert len(set(keys)) == len(keys), path
