"""The package as a whole: imports, argument types, and values accepted as a scene."""

from __future__ import annotations

import ast
import importlib
import importlib.util
import inspect
import pathlib
import re

import carom
import pytest
from conftest import SOURCE

ROOT = pathlib.Path(carom.__file__).parent
SOURCES = {
    ".".join(("carom", *path.relative_to(ROOT).with_suffix("").parts)).removesuffix(".__init__"):
        path.read_text(encoding="utf-8")
    for path in ROOT.rglob("*.py")
    if path.is_file()  # an old build folder may hold dangling links
}


def imported(node):
    """The modules that a statement may import."""
    if isinstance(node, ast.Import):
        return {alias.name for alias in node.names}
    if not isinstance(node, ast.ImportFrom):
        return set()
    return {node.module, *(f"{node.module}.{alias.name}" for alias in node.names)}


def wrong_imports(sources):
    """Modules in import cycles, including imports for type checking, and imports of the package inside
    functions."""
    trees = {name: ast.parse(text) for name, text in sources.items()}
    # The package itself is excluded: importing any of its modules imports it.
    edges = {
        name: {
            other for node in ast.walk(tree) for other in imported(node) if other in sources
            and other not in ("carom", name)}
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


def test_modules_import_without_cycles_and_at_the_top():
    assert wrong_imports(SOURCES) == ([], [])


@pytest.mark.parametrize(
    ("planted", "wrong"),
    [
        ({"carom._scene": "from carom import _record"}, ({"carom._record", "carom._scene"}, [])),
        ({"carom._scene": "if TYPE_CHECKING:\n    from carom._record import Record"},
         ({"carom._record", "carom._scene"}, [])),
        ({"carom._toml": "def f():\n    import carom._isa"}, (set(), ["carom._toml:2"])),
        ({"carom._toml": "class A:\n    def f(self):\n        from carom import plot\n"},
         ({"carom._toml", "carom.plot"}, ["carom._toml:3"])),
    ],
)
def test_a_cycle_and_a_hidden_import_are_found(planted, wrong):
    circle, hidden = wrong_imports(SOURCES | planted)
    assert hidden == wrong[1]
    assert wrong[0] <= set(circle) and bool(circle) == bool(wrong[0])


#: Names that stand for Literal.
NAMES = ("GameName", "RackName", "TableName", "CameraName", "OverlayName", "BallBallModel", "CushionModel")
#: Each value with the annotations that accept it.
WRONG = [
    ((), b"bytes"),
    ((), object()),
    (("None",), None),
    (("int", "float", "ArrayLike"), 5),
    (("float", "ArrayLike"), 2.5),
    (("int",), 10**400),  # too large for a double
    (("str", "Literal", "SceneLike", *NAMES), "a text"),
    (("list",), [object()]),
    (("Mapping", "dict", "SceneLike"), {"a": object()}),
]


def public_functions():
    """The functions and methods of carom's public names, without those of other packages."""
    modules = [carom, carom.games, carom.kernel, carom.plot, carom.scenes, carom.sweep,
               importlib.import_module("carom.io.pooltool")]
    if importlib.util.find_spec("pettingzoo"):
        modules += map(importlib.import_module, ("carom.gym", "carom.gym.match", "carom.gym._env"))
    for module in modules:
        for name in getattr(module, "__all__", ("env", "MatchEnv", "TableOptions")):
            public = getattr(module, name, None)
            if inspect.isfunction(public):
                yield f"{module.__name__}.{name}", public
            if not inspect.isclass(public) or issubclass(public, Exception):
                continue
            for method, part in inspect.getmembers(public, callable):
                own = (getattr(part, "__module__", None) or "").startswith("carom")
                if own and not method.startswith("_") and not inspect.isclass(part):
                    yield f"{module.__name__}.{name}.{method}", part
            if "__init__" in vars(public):
                yield f"{module.__name__}.{name}", public


def arguments():
    for name, function in public_functions():
        for parameter in inspect.signature(function).parameters.values():
            named = "word" if parameter.kind is parameter.VAR_KEYWORD else parameter.name
            if parameter.annotation is not parameter.empty and "Any" not in re.sub(
                r"\[.*\]", "", parameter.annotation
            ):
                yield pytest.param(function, named, parameter.annotation, id=f"{name}({parameter})"[:120])


@pytest.mark.parametrize(("function", "name", "annotation"), list(arguments()))
def test_a_wrong_type_is_refused_naming_the_argument(function, name, annotation):
    whole = annotation
    while "[" in whole:
        whole = re.sub(r"\[[^\[\]]*\]", "", whole)
    for kinds, value in WRONG:
        if set(kinds) & set(whole.split(" | ")):
            continue
        # The type is checked before missing arguments are reported.
        with pytest.raises(
            (TypeError, ValueError), match=rf"^{name}: expected .+, not .+ \({type(value).__name__}\)$"
        ):
            function(**{name: value})


def test_scene_arguments_accept_a_path_or_a_tree(draw_scene):
    path = SOURCE / "scenes/draw.toml"
    takers = [
        lambda scene: carom.simulate(scene).hash(),
        lambda scene: carom.simulate_many(scene, shots=2, hashes=True).hash.tolist(),
        lambda scene: next(carom.render(scene, times=[0.0], size=(64, 36))).tobytes(),
        lambda scene: carom.margin(scene, runs=1, render=False)["frames"],
        lambda scene: carom.Record.final_scene(carom.simulate(draw_scene), scene=scene).text(),
        lambda scene: carom.games.pocket_lines(scene, draw_scene.ids[1]),
        lambda scene: carom.sweep.columns(scene, {"cue.speed": [2.0]}, 1)["duration"].tolist(),
        lambda scene: carom.sweep.plan(scene, {"cue.speed": [2.0]}, 1).probe,
        lambda scene: carom.solve(scene, "scratch", shots=1000, best=1)[0].values,
    ]
    for take in takers:
        wanted = take(draw_scene)
        assert all(take(like) == wanted for like in (path, str(path), draw_scene.to_dict()))
        with pytest.raises(carom.SceneError, match="nowhere.toml: cannot be read: there is no such file"):
            take("nowhere.toml")


def test_a_warning_names_the_simulating_line():
    with pytest.warns(UserWarning, match="the elevated cue would give") as told:
        carom.simulate(SOURCE / "scenes/masse.toml", until=0.1)
    assert told[0].filename == __file__
