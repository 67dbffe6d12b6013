"""Tests of .ci/check_prose and .ci/list_messages on short texts whose findings are known, and the committed list of messages."""
import difflib
import importlib.machinery
import importlib.util
import pathlib
import unittest

CI = pathlib.Path(__file__).resolve().parents[2] / ".ci"


def script(name: str):
    loader = importlib.machinery.SourceFileLoader(name, str(CI / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


check = script("check_prose")
listing = script("list_messages")

GLOSSARY = """| term | meaning | source | avoid |
| --- | --- | --- | --- |
| medium | What fills a region. | | matter, `Surroundings` |
| maximum | The largest value. | | `kMost…` |
"""


class Rules(unittest.TestCase):
    def rules(self, text: str, name: str = "scene/a.h") -> list[str]:
        return [f.rule for f in check.code_findings(name, text, check.vocabulary(GLOSSARY))]

    def test_the_vocabulary_is_the_last_column(self):
        self.assertEqual(check.vocabulary(GLOSSARY), ({"matter"}, {"Surroundings"}, ("kMost",)))

    def test_words_are_found_inside_identifiers_and_texts(self):
        self.assertEqual(self.rules('int innerMatter = matter_of("no matter");'), ["words"] * 3)
        self.assertEqual(self.rules("int shattered = 0;"), [])

    def test_names_are_found_whole_and_by_prefix(self):
        self.assertEqual(self.rules("Surroundings s = kMostShapes;"), ["words"] * 2)
        self.assertEqual(self.rules("SurroundingsOfPath s;"), [])

    def test_a_block_that_opens_without_subject_is_a_fragment(self):
        self.assertEqual(self.rules("/// Of a ray, the end.\nint a;\n/// By which paths end.\nint b;\n// Whether it ends.\nint c;"), ["fragments"] * 3)
        self.assertEqual(self.rules("/// Offset of a ray.\n/// Of later lines only the first one counts.\nint a;"), [])

    def test_a_member_comment_that_continues_the_last_one_runs_on(self):
        self.assertEqual(self.rules("int a;  ///< Width,\nint b;  ///< and height.\n"), ["run-on"])
        self.assertEqual(self.rules("int a;  ///< Width.\nint b;  ///< height.\n"), [])
        self.assertEqual(self.rules("int a;  ///< Width,\n\nint b;  ///< and height.\n"), [])

    def test_sentences_have_at_most_thirty_words_in_comments(self):
        self.assertEqual(self.rules("// " + "word " * 30 + "end."), ["long-comments"])
        self.assertEqual(self.rules("// " + "word " * 29 + "end."), [])

    def test_sentences_have_at_most_thirty_five_words_in_the_manual(self):
        text = "word " * 35 + "end."
        self.assertEqual([f.place for f in check.manual_findings("docs/a.md", f"Short.\n\n{text}\n")], ["docs/a.md:3"])
        self.assertEqual(check.manual_findings("docs/a.md", f"```\n{text}\n```\n| {text} |\n"), [])


class Baseline(unittest.TestCase):
    def test_a_count_above_the_baseline_is_a_complaint(self):
        self.assertEqual(check.risen({"words": {"io": 2}}, {"words": {"io": 2}}), [])
        self.assertEqual(len(check.risen({"words": {"io": 3}}, {"words": {"io": 2, "lens": 9}})), 1)
        self.assertEqual(len(check.risen({"words": {"io": 1}}, {})), 1)

    def test_every_row_of_the_glossary_has_four_columns(self):
        glossary = (CI.parent / "docs" / "glossary.md").read_text()
        rows = [line.split("|") for line in glossary.splitlines() if line.startswith("| ")]
        self.assertGreater(len(rows), 50)
        self.assertTrue(all(len(row) == 6 for row in rows))


class Messages(unittest.TestCase):
    def test_adjacent_literals_of_cpp_are_one_text(self):
        source = 'f("no such " // why\n  "light", R"(a raw\ntext)"); // "in a comment"\nchar c = \'"\';\n#include "a b.h"\n'
        self.assertEqual(listing.texts_of_cpp(source), ["no such light", "a raw\ntext"])

    def test_fields_of_fstrings_are_braces(self):
        self.assertEqual(sorted(listing.texts_of_python('f"got {x} here"\n"plain text"')), ["got {} here", "plain text"])

    def test_keys_and_formats_are_no_messages(self):
        self.assertTrue(listing.is_message("no such light (got {})"))
        for key in ("focal_length", "{} {}", "XYZ D65", "%d", "/lights/0"):
            self.assertFalse(listing.is_message(key), key)

    def test_the_committed_list_is_that_of_the_source(self):
        changed = list(difflib.unified_diff(listing.GOLDEN.read_text().splitlines(), listing.messages().splitlines(), "messages.txt", "source", n=0, lineterm=""))
        self.assertEqual(changed, [], "read the new texts once as a stranger, then run .ci/list_messages --update:\n" + "\n".join(changed))


if __name__ == "__main__":
    unittest.main()
