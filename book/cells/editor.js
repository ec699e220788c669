// The editor of a cell: CodeMirror, loaded when the first cell is edited.

import { python } from "@codemirror/lang-python";
import { HighlightStyle, bracketMatching, indentOnInput, indentUnit, syntaxHighlighting } from "@codemirror/language";
import { EditorView, minimalSetup } from "codemirror";
import { keymap } from "@codemirror/view";
import { indentWithTab } from "@codemirror/commands";
import { Prec } from "@codemirror/state";
import { tags } from "@lezer/highlight";

// The colours of the figures keep apart for every eye, and are readable as text in light and dark.
const style = HighlightStyle.define([
  { tag: [tags.keyword, tags.operatorKeyword, tags.controlKeyword], color: "var(--dh-accent)" },
  { tag: [tags.string, tags.special(tags.string)], color: "var(--dh-y)" },
  { tag: [tags.number, tags.bool, tags.null], color: "var(--dh-x)" },
  { tag: [tags.function(tags.variableName), tags.function(tags.definition(tags.variableName)), tags.className], color: "var(--dh-z)" },
  { tag: tags.comment, color: "var(--dh-muted)", fontStyle: "italic" },
]);

const theme = EditorView.theme({
  "&": { color: "var(--dh-ink)", backgroundColor: "var(--dh-ground)" },
  "&.cm-focused": { outline: "3px solid var(--dh-z)", outlineOffset: "1px" },
  ".cm-scroller": { fontFamily: "var(--pst-font-family-monospace, monospace)", lineHeight: "1.5" },
  ".cm-gutters": { backgroundColor: "var(--dh-ground)", color: "var(--dh-muted)", border: "none" },
  ".cm-activeLine, .cm-activeLineGutter": { backgroundColor: "color-mix(in srgb, var(--dh-faint) 35%, transparent)" },
  ".cm-cursor": { borderLeftColor: "var(--dh-ink)" },
  "&.cm-focused .cm-selectionBackground, .cm-selectionBackground": { backgroundColor: "color-mix(in srgb, var(--dh-z) 30%, transparent) !important" },
  ".cm-matchingBracket": { backgroundColor: "var(--dh-faint) !important", color: "inherit !important" },
  ".cm-tooltip": { color: "var(--dh-ink)", backgroundColor: "var(--dh-ground)", borderColor: "var(--dh-body)" },
});

/** An editor in `parent`; `changed(text)`, `run()` and `leave()` are what its reader does. */
globalThis.DhEditor = ({ parent, text, label, changed, run, leave }) => new EditorView({
  parent,
  doc: text,
  extensions: [
    Prec.highest(keymap.of([
      { key: "Shift-Enter", run: () => (run(), true) },
      { key: "Mod-Enter", run: () => (run(), true) },
      { key: "Escape", run: () => (leave(), true) },
      indentWithTab,
    ])),
    minimalSetup,
    indentOnInput(),
    bracketMatching(),
    python(),
    indentUnit.of("    "),
    syntaxHighlighting(style),
    theme,
    EditorView.lineWrapping,
    EditorView.contentAttributes.of({ "aria-label": label }),
    EditorView.updateListener.of((update) => { if (update.docChanged) changed(update.state.doc.toString()); }),
  ],
});
