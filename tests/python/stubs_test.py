import ast
import inspect
import unittest
from pathlib import Path

import hypotrack


def stub_names():
    """The public names of the stub file; of classes with those of their members."""
    tree = ast.parse(Path(hypotrack.__file__).with_suffix(".pyi").read_text())
    names = {}
    for node in tree.body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            body = node.body if isinstance(node, ast.ClassDef) else []
            names[node.name] = {
                getattr(m, "name", None) or m.target.id for m in body
                if isinstance(m, (ast.FunctionDef, ast.AnnAssign))}
    return names


class Stubs(unittest.TestCase):
    def test_name_all_that_the_package_offers(self):
        stub = stub_names()
        self.assertEqual(sorted(stub), sorted(hypotrack.__all__))
        for name, members in stub.items():
            offered = getattr(hypotrack, name)
            if not inspect.isclass(offered) or issubclass(offered, Exception):
                continue
            public = {m for m in vars(offered) if not m.startswith("_")}
            self.assertEqual({m for m in members if not m.startswith("_")}, public, name)

    def test_say_how_status_is_used(self):
        # It is an enumeration of C++, which Python cannot iterate.
        self.assertEqual(set(hypotrack.Status.__members__),
                         stub_names()["Status"] - {"name", "value", "__members__", "__init__",
                                                   "__int__"})
        self.assertNotIn("enum.Enum", Path(hypotrack.__file__).with_suffix(".pyi").read_text())

    def test_every_function_has_a_docstring(self):
        for name in hypotrack.__all__:
            offered = getattr(hypotrack, name)
            self.assertTrue(offered.__doc__, name)
            if inspect.isclass(offered) and not issubclass(offered, Exception):
                for key, member in vars(offered).items():
                    if callable(member) and not key.startswith("_"):
                        self.assertIn("\n", member.__doc__, f"{name}.{key}: only a signature")


if __name__ == "__main__":
    unittest.main()
