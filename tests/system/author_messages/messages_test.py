#!/usr/bin/env python3
"""Compiles plugins with the mistakes that authors make; each must give one short message.

usage: messages_test.py COMPILER FLAG...
"""

import subprocess
import sys
import unittest

COMPILER = sys.argv[1:]
NAMES = ["-DHYPOTRACK_PLUGIN_KIND=optimizer", "-DHYPOTRACK_PLUGIN_NAME=mine",
         '-DHYPOTRACK_PLUGIN_VERSION="1.0"', '-DHYPOTRACK_PLUGIN_LICENCE="Apache-2.0"']

FUNCTIONS = """
  std::int64_t default_evaluations() const override { return 1; }
  OptimizerResult minimize(CostFunction&, const SearchRegion&, const Budget&,
                           std::uint64_t) override { return {}; }
"""
PARAMS = """
  struct Params {
    int size = 4;
    void visit(ParamVisitor& v) { v("size", size, {.help = "a number"}); }
  };
"""


def mine(content, base="public Optimizer"):
    return "class Mine : %s {\n public:\n%s};\n" % (base, content)


GOOD = mine(PARAMS + "  explicit Mine(const Params&) {}\n" + FUNCTIONS)


class Messages(unittest.TestCase):
    def errors(self, plugin, standard="-std=c++20"):
        text = ('#include "hypotrack/plugin/plugin.hpp"\nusing namespace hypotrack;\n' + plugin +
                'HYPOTRACK_PLUGIN(Mine, "a plugin", "")\n')
        done = subprocess.run(
            COMPILER + NAMES + [standard, "-fsyntax-only", "-fdiagnostics-color=never", "-x", "c++",
                                "-"], input=text, capture_output=True, text=True, check=False)
        return [line for line in done.stderr.splitlines() if "error: " in line]

    def expect(self, plugin, piece, standard="-std=c++20"):
        errors = self.errors(plugin, standard)
        self.assertEqual(len(errors), 1, "\n".join(errors))
        self.assertIn(piece, errors[0])

    def test_a_plugin_without_a_mistake_gives_none(self):
        self.assertEqual(self.errors(GOOD), [])

    def test_another_base_class(self):
        self.expect(mine(PARAMS + "  explicit Mine(const Params&) {}\n", "public Output"),
                    "does not derive from the interface of its kind. Write `class Mine : public")

    def test_no_params(self):
        self.expect(mine("  explicit Mine(int) {}\n" + FUNCTIONS),
                    "has no public type Params. Write `struct Params {")

    def test_no_visit(self):
        self.expect(GOOD.replace("void visit", "void walk"),
                    "no public `void visit(hypotrack::ParamVisitor& v)`")

    def test_no_constructor_from_the_parameters(self):
        self.expect(GOOD.replace("explicit Mine(const Params&)", "Mine()"),
                    "Write a public `explicit Mine(const Params& params)`")

    def test_a_type_that_no_parameter_has(self):
        self.expect(GOOD.replace("int size = 4", "float size = 4"),
                    "use bool, integers, double, std::string")

    def test_a_function_of_the_interface_is_missing(self):
        without = GOOD.replace(
            "  std::int64_t default_evaluations() const override { return 1; }\n", "")
        self.expect(without, "abstract class type")

    def test_an_older_standard(self):
        self.expect(GOOD, "hypotrack needs C++20: compile with -std=c++20", "-std=c++17")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
