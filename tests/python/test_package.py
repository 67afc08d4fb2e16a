"""The package as a whole: who imports whom."""

from __future__ import annotations

import ast
import pathlib

import carom
import pytest

ROOT = pathlib.Path(carom.__file__).parent
SOURCES = {
    ".".join(("carom", *path.relative_to(ROOT).with_suffix("").parts)).removesuffix(".__init__"): path.read_text(encoding="utf-8")
    for path in ROOT.rglob("*.py")
    if path.is_file()  # in a folder that was built in before, what is gone left its link
}


def imported(node):
    """The modules that a statement may import."""
    if isinstance(node, ast.Import):
        return {alias.name for alias in node.names}
    return {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)} if isinstance(node, ast.ImportFrom) else set()


def wrong_imports(sources):
    """Modules that import each other in a circle, checkers of types included, and imports of the package inside functions."""
    trees = {name: ast.parse(text) for name, text in sources.items()}
    # The package itself is no part of a circle: whoever imports one of its modules has it.
    edges = {
        name: {other for node in ast.walk(tree) for other in imported(node) if other in sources and other not in ("carom", name)}
        for name, tree in trees.items()
    }
    while free := {name for name in edges if not edges[name] & edges.keys()}:
        edges = {name: others for name, others in edges.items() if name not in free}
    hidden = {
        f"{name}:{node.lineno}"
        for name, tree in trees.items()
        for function in ast.walk(tree)
        if isinstance(function, (ast.FunctionDef, ast.AsyncFunctionDef, ast.Lambda))
        for node in ast.walk(function)
        if any(f"{other}.".startswith("carom.") for other in imported(node))
    }
    return sorted(edges), sorted(hidden)


def test_modules_import_each_other_in_no_circle_and_at_the_top():
    assert wrong_imports(SOURCES) == ([], [])


@pytest.mark.parametrize(
    ("planted", "wrong"),
    [
        ({"carom._scene": "from carom import _record"}, ({"carom._record", "carom._scene"}, [])),
        ({"carom._scene": "if TYPE_CHECKING:\n    from carom._record import Record"}, ({"carom._record", "carom._scene"}, [])),
        ({"carom._toml": "def f():\n    import carom._isa"}, (set(), ["carom._toml:2"])),
        ({"carom._toml": "class A:\n    def f(self):\n        from carom import plot\n"}, ({"carom._toml", "carom.plot"}, ["carom._toml:3"])),
    ],
)
def test_a_circle_and_a_hidden_import_are_found(planted, wrong):
    circle, hidden = wrong_imports(SOURCES | planted)
    assert hidden == wrong[1]
    assert wrong[0] <= set(circle) and bool(circle) == bool(wrong[0])
