"""Everything that the extension shows is translated, and nothing else."""

import importlib.util
import re
from pathlib import Path
from string import Formatter
from types import SimpleNamespace

import bpy
import pytest
import shown_texts
from mobius_flow.addon import registration, translations
from mobius_flow.addon.curves.recorded import turn
from mobius_flow.addon.live.requirements import RELAXABLE
from mobius_flow.addon.pictures.movie import target
from mobius_flow.addon.translations import ANY
from mobius_flow.core import MobiusFlowError
from mobius_flow.core.base.messages import Message
from mobius_flow.core.driver.words import named

FOLDER = Path(translations.__file__).parent
TABLES = translations.tables(FOLDER)
GERMAN = TABLES["de"]


@pytest.mark.parametrize("code", TABLES)
def test_everything_shown_is_translated_and_nothing_else(code):
    shown = {(ANY, text) for text in shown_texts.tooltips()}
    shown |= {(translations.CONTEXT, text) for text in shown_texts.labels() | shown_texts.sentences()}
    missing = [f'msgctxt "{context}"\nmsgid "{text}"\n' for context, text in sorted(shown - TABLES[code].keys())]
    assert not missing, "\n".join(missing)
    assert not TABLES[code].keys() - shown, "stale"
    entries = (FOLDER / f"{code}.po").read_text(encoding="utf-8").count("\nmsgid ")
    assert len(TABLES[code]) == entries - 1, "there twice, or on several lines"


@pytest.mark.parametrize("code", TABLES)
def test_translations_have_the_form_of_their_originals(code):
    sentences = shown_texts.sentences()
    for (_, text), said in TABLES[code].items():
        if text in sentences:
            assert fields(said) == fields(text), text
        assert said.strip() == said
        assert said[-1] == "." or text[-1] != ".", text


def fields(template):
    return sorted((name, spec) for _, name, spec, _ in Formatter().parse(template) if name is not None)


def test_german_addresses_nobody():
    address = re.compile(r"\b([Dd]u|[Dd]ein\w*|Ihr\w*|[Bb]itte)\b|\w+en Sie\b")
    assert not [said for said in GERMAN.values() if address.search(said)]


def test_nothing_is_shown_that_nobody_could_translate(tmp_path):
    assert not [(path, line) for path in shown_texts.ADDON.rglob("*.py") for line in shown_texts.unmarked(path)]
    lines = (
        "self.report({'ERROR'}, 'No')",
        "self.report({'ERROR'}, str(error))",
        "cls.poll_message_set(reason)",
        "Refusal('No')",
        "Message(f'{name} is closed')",
        "layout.label(text=f'Add {name}')",
        "sentence(layout, context, f'{name} is open')",
        "manager.invoke_confirm(self, event, message=f'{name} is there already')",
    )
    path = tmp_path / "module.py"
    path.write_text("\n".join(lines))
    assert set(shown_texts.unmarked(path)) == set(range(1, len(lines) + 1)), "the search finds what is not marked"


def test_po_files_are_read_as_blenders_own_tools_read_them():
    if importlib.util.find_spec("_bl_i18n_utils") is None:
        pytest.skip("this Blender has no translation tools")
    from _bl_i18n_utils.utils import I18nMessages

    messages = I18nMessages("de", "PO", src=str(FOLDER / "de.po"))
    assert not messages.parsing_errors
    assert {key: message.msgstr for key, message in messages.msgs.items() if key[1]} == GERMAN


def test_names_have_our_context_and_blenders_own_properties_do_not():
    pick = bpy.ops.curve.mobius_flow_pick_knot.get_rna_type()
    assert pick.translation_context == pick.properties["knot"].translation_context == translations.CONTEXT
    assert pick.properties["align"].translation_context == bpy.app.translations.contexts.default
    for cls in registration.CLASSES:
        if not issubclass(cls, bpy.types.PropertyGroup):
            assert getattr(bpy.types, cls.__name__).bl_rna.translation_context == translations.CONTEXT


def test_blender_is_told_the_tables_and_to_forget_them(monkeypatch):
    told = {}
    monkeypatch.setattr(translations, "translations", SimpleNamespace(register=told.__setitem__, unregister=told.pop))
    translations.register()
    assert told == {"mobius_flow.addon.translations": TABLES}
    assert GERMAN[translations.CONTEXT, "Links"] == "Verschlingungen"
    assert GERMAN["*", "What stays"] == "Was bleibt"
    translations.unregister()
    assert not told


def german(text):
    return GERMAN[translations.CONTEXT, text]


def test_what_is_refused_in_german(tmp_path):
    bpy.ops.curve.mobius_flow_add_knot(knot="3_1")
    curve = bpy.context.active_object
    curve.name, curve.data.dimensions = "{Knot}", "2D"
    with pytest.raises(RuntimeError, match=r"'\{Knot\}' is a 2D curve"):
        bpy.ops.curve.mobius_flow_relax()
    assert RELAXABLE(bpy.context).sentence.said(german).startswith("'{Knot}' ist eine 2D-Kurve")
    curve.name, curve.data.dimensions = "Knot", "3D"
    curve.constraints.new("LIMIT_LOCATION")
    with pytest.raises(MobiusFlowError) as caught:
        turn([curve])
    said = str(caught.value).said(german)
    assert said == "'Knot' wird bewegt (Beschränkung); das zuerst entfernen"
    with pytest.raises(MobiusFlowError) as caught:
        target(str(tmp_path))
    assert str(caught.value).said(german) == f"{tmp_path} ist ein Verzeichnis; eine Datei darin angeben"


def test_errors_hand_phrases_on_and_names_are_joined_in_german():
    assert named(["A", "B", "C"]).said(german) == "'A', 'B' und 'C'"
    assert named("ABCDEF").said(german) == "'A', 'B', 'C' und 3 weitere"
    phrase = Message("{names} is being relaxed; stop that first", names=named(["A", "B"]))
    said = str(MobiusFlowError(phrase)).said(german)
    assert said == "'A' und 'B': Entspannung läuft; diese zuerst beenden"


def test_what_nobody_has_translated_stays_as_it_is():
    for text in ("a sentence of the core, {with braces}", "5_2"):
        assert translations.rpt_(text) == translations.iface_(text) == translations.tip_(text) == text
