# SPDX-FileCopyrightText: 2026 The Lanthorn authors
# SPDX-License-Identifier: Apache-2.0
"""Every public name has a docstring and is in the stub, and the stub has no other names."""

import ast
import pathlib
import re
import unittest

import lanthorn

STUB = pathlib.Path(lanthorn.__file__).with_name("__init__.pyi")
SHOWN = {"__init__", "__getitem__", "__contains__", "__array__", "__iter__", "__next__", "__len__"}
PLAIN = {"__version__", "Error", "DIRECT", "CAUSTIC", "INDIRECT"}


def stub_names(body):
    """Returns {name: node} for the body of a module or a class."""
    names = {}
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names[node.name] = node
        elif isinstance(node, ast.AnnAssign):
            names[node.target.id] = node
    return names


def public(names):
    return {n for n in names if n in SHOWN or not n.startswith("_")}


class Stub(unittest.TestCase):
    def setUp(self):
        self.stub = stub_names(ast.parse(STUB.read_text()).body)

    def test_names_of_the_module(self):
        self.assertEqual(set(lanthorn.__all__), set(self.stub))

    def test_members_of_classes(self):
        for name, node in self.stub.items():
            if not isinstance(node, ast.ClassDef) or name == "Error":
                continue
            own = public(vars(getattr(lanthorn, name)))
            if "def __init__" not in ast.unparse(node):
                own.discard("__init__")  # pybind11 has one that raises
            # Attributes that only instances have are not in vars() of the class.
            alone = {n for n, m in stub_names(node.body).items() if isinstance(m, ast.AnnAssign) and n not in own}
            self.assertEqual(own, set(stub_names(node.body)) - alone, name)

    def test_parameters(self):
        for name, node in self.stub.items():
            members = [(name, node, getattr(lanthorn, name))]
            if isinstance(node, ast.ClassDef):
                members = [(f"{name}.{n}", m, getattr(getattr(lanthorn, name), n, None)) for n, m in stub_names(node.body).items()]
            for path, function, value in members:
                if not isinstance(function, ast.FunctionDef) or function.decorator_list:
                    continue
                arguments = [a.arg for a in function.args.args + function.args.kwonlyargs if a.arg != "self"]
                words = value.__doc__ if value.__module__ != "lanthorn" else None
                if words and "(" in words.splitlines()[0] and not path.endswith("__"):
                    shown = re.findall(r"(\w+): (?!\w*lanthorn\._lanthorn\.\w+\) ->)", words.splitlines()[0].split(" -> ")[0])
                    self.assertEqual([a for a in shown if a != "self"], arguments, path)

    def test_docstrings(self):
        self.assertGreater(len(lanthorn.__doc__), 500)
        for name, node in self.stub.items():
            value = getattr(lanthorn, name)
            if name not in PLAIN:
                self.assertTrue(value.__doc__ and len(value.__doc__) > 30, name)
            if not isinstance(node, ast.ClassDef) or name == "Error":
                continue
            for member in stub_names(node.body):
                if member not in PLAIN and hasattr(value, member):
                    self.assertTrue(getattr(value, member).__doc__, f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
