"""One small fault put into one module when it is imported: what the tests of `mutants.py` are to notice.

The environment variable GMDS_MUTANT, `module:number`, says which; it holds in child processes too.
"""

from __future__ import annotations

import ast
import importlib.machinery
import importlib.util
import os
import sys
from collections.abc import Sequence
from types import CodeType, ModuleType
from typing import Any

COMPARED: dict[type[ast.cmpop], type[ast.cmpop]] = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq,
    ast.In: ast.NotIn, ast.NotIn: ast.In, ast.Is: ast.IsNot, ast.IsNot: ast.Is,
}  # fmt: skip
COMPUTED: dict[type[ast.operator], type[ast.operator]] = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult, ast.FloorDiv: ast.Mult, ast.Mod: ast.Mult,
    ast.BitAnd: ast.BitOr, ast.BitOr: ast.BitAnd, ast.LShift: ast.RShift, ast.Pow: ast.Mult,
}  # fmt: skip


class Mutation(ast.NodeTransformer):
    """Counts the places where a fault can be put, and puts one at the place `wanted`."""

    def __init__(self, wanted: int = -1) -> None:
        self.wanted, self.count, self.told = wanted, 0, ""

    def here(self, node: ast.AST, told: str) -> bool:
        """Whether this place is the one."""
        self.count += 1
        if self.count - 1 == self.wanted:
            self.told = f"line {getattr(node, 'lineno', 0)}: {told}"
            return True
        return False

    def visit_arguments(self, node: ast.arguments) -> Any:
        """Defaults, but no annotations."""
        node.defaults = [self.visit(default) for default in node.defaults]
        return node

    def visit_AnnAssign(self, node: ast.AnnAssign) -> Any:
        """Values, but no annotations."""
        node.value = self.visit(node.value) if node.value else None
        return node

    def visit_FunctionDef(self, node: ast.FunctionDef) -> Any:
        """Bodies; no docstring, no decorator, no annotation."""
        node.args = self.visit_arguments(node.args)
        node.body = [self.visit(statement) for statement in node.body]
        return node

    def visit_JoinedStr(self, node: ast.JoinedStr) -> Any:
        """Messages are left alone."""
        return node

    def visit_If(self, node: ast.If) -> Any:
        """The other branch."""
        if isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING":
            return node
        if self.here(node, "the other branch"):
            node.test = ast.UnaryOp(ast.Not(), node.test)
        return self.generic_visit(node)

    def visit_Raise(self, node: ast.Raise) -> Any:
        """No error."""
        return ast.Pass() if self.here(node, "no error") else node

    def visit_Return(self, node: ast.Return) -> Any:
        """Nothing comes back."""
        if node.value is not None and self.here(node, "nothing comes back"):
            return ast.Return(ast.Constant(None))
        return self.generic_visit(node)

    def visit_Compare(self, node: ast.Compare) -> Any:
        """Another comparison."""
        for i, operator in enumerate(node.ops):
            if type(operator) in COMPARED and self.here(node, f"{type(operator).__name__} is another"):
                node.ops[i] = COMPARED[type(operator)]()
        return self.generic_visit(node)

    def visit_BinOp(self, node: ast.BinOp) -> Any:
        """Another operation."""
        if type(node.op) in COMPUTED and self.here(node, f"{type(node.op).__name__} is another"):
            node.op = COMPUTED[type(node.op)]()
        return self.generic_visit(node)

    def visit_BoolOp(self, node: ast.BoolOp) -> Any:
        """And is or, or is and."""
        if self.here(node, "and is or, or is and"):
            node.op = ast.And() if isinstance(node.op, ast.Or) else ast.Or()
        return self.generic_visit(node)

    def visit_UnaryOp(self, node: ast.UnaryOp) -> Any:
        """No sign, no negation."""
        if self.here(node, f"no {type(node.op).__name__}"):
            return self.visit(node.operand)
        return self.generic_visit(node)

    def visit_Constant(self, node: ast.Constant) -> Any:
        """One more; true is false."""
        if type(node.value) in (int, float, bool) and self.here(node, f"{node.value} is another"):
            return ast.Constant(not node.value if isinstance(node.value, bool) else node.value + 1)
        return node


def places(source: str) -> int:
    """How many faults can be put into a module."""
    counter = Mutation()
    counter.visit(ast.parse(source))
    return counter.count


def faulty(source: str, number: int) -> tuple[ast.Module, str]:
    """The module with one fault, and where it is."""
    mutation = Mutation(number)
    return ast.fix_missing_locations(mutation.visit(ast.parse(source))), mutation.told


class Finder:
    """Finds the module that is to have a fault."""

    def __init__(self, name: str, number: int) -> None:
        self.name, self.number = name, number

    def find_spec(self, name: str, path: Sequence[str] | None, target: ModuleType | None = None) -> Any:
        """The module with its fault; None for all others."""
        if name != self.name:
            return None
        found = importlib.machinery.PathFinder.find_spec(name, path)
        if found is None or not isinstance(found.origin, str):
            return None
        number = self.number

        class Loader(importlib.machinery.SourceFileLoader):
            def get_code(self, fullname: str) -> CodeType:
                with open(self.path, encoding="utf-8") as file:
                    return compile(faulty(file.read(), number)[0], self.path, "exec")

        submodules = found.submodule_search_locations
        loader = Loader(name, found.origin)
        return importlib.util.spec_from_file_location(
            name, found.origin, loader=loader, submodule_search_locations=submodules
        )


def install() -> None:
    """Put the fault that the environment asks for where it will be imported."""
    if told := os.environ.get("GMDS_MUTANT"):
        name, number = told.rsplit(":", 1)
        sys.meta_path.insert(0, Finder(name, int(number)))  # type: ignore[arg-type]
