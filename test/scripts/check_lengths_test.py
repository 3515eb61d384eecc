"""scripts/check_lengths.py finds the extent of functions in formatted code."""

import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
import check_lengths  # noqa: E402


def functions(text):
    return list(check_lengths.functions(text.splitlines()))


class CheckLengths(unittest.TestCase):
    def test_a_function_reaches_from_its_header_to_its_closing_brace(self):
        text = "namespace a {\n\nint sum(int a,\n        int b) {\n  if (a) {\n    return b;\n  }\n  return a + b;\n}\n\n}\n"
        self.assertEqual(functions(text), [("sum", 3, 7)])

    def test_methods_inside_of_a_class_are_measured(self):
        text = "class A {\n public:\n  void f() {\n    g();\n  }\n  int n() const { return 1; }\n};\n"
        self.assertEqual(functions(text), [("f", 3, 3)])

    def test_a_long_function_is_longer_than_the_limit(self):
        text = "void f() {\n" + "  g();\n" * check_lengths.MAX_FUNCTION_LINES + "}\n"
        self.assertGreater(functions(text)[0][2], check_lengths.MAX_FUNCTION_LINES)


if __name__ == "__main__":
    unittest.main()
