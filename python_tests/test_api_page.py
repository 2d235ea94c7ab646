"""`docs/book/python.md` is what the docstrings of the package say; with ENMM_WRITE_API=1 the test writes the page."""

import ast
import inspect
import os
import textwrap
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "ffi" / "python" / "enmm"
PAGE = ROOT / "docs" / "book" / "python.md"
WIDTH = 118
CHAPTERS = {
    "Runs and factors of safety": ["_tasks", "_results", "_table", "_frames"],
    "Cases": ["_case", "_data", "_doors"],
    "Models": ["_model", "_ports", "_parameters", "_batch", "_core"],
    "Values": ["_types", "_values", "_records", "_abi"],
    "Errors and warnings": ["_errors"],
    "Library and program": ["_library", "_program"],
}
"""Modules whose names `enmm` has, by chapters of the page."""
MODULES = ["aio", "ensemble", "umbridge", "precice"]
"""Modules with names of their own."""
HEAD = """# Python API

Every public name of the package `enmm`, with what its docstring says. `cargo xtask api` writes this page. Set-up and
first steps: [From Rust, C, C++ and Python](libraries.md). Units are SI, per metre of thickness.
"""
Named = ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef


def names_of(tree: ast.Module) -> list[str]:
    """The names in `__all__`, or without it all that are public."""
    for node in tree.body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return ast.literal_eval(node.value)
    return [node.name for node in tree.body if isinstance(node, Named) and not node.name.startswith("_")]


def parsed(module: str) -> ast.Module:
    place = PACKAGE / module
    file = place / "__init__.py" if place.is_dir() else place.with_suffix(".py")
    tree = ast.parse(file.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.arg):
            node.annotation = unquoted(node.annotation)
        elif isinstance(node, ast.FunctionDef):
            node.returns = unquoted(node.returns)
    return tree


def unquoted(kind: ast.expr | None) -> ast.expr | None:
    """A type without the quotes of names that only type checkers import."""
    is_text = isinstance(kind, ast.Constant) and isinstance(kind.value, str)
    return ast.parse(kind.value, mode="eval").body if is_text else kind


def documented(body: list[ast.stmt]) -> Iterator[tuple[ast.stmt, str]]:
    """Statements with the text in the line below them."""
    for node, below in zip(body, body[1:]):
        is_text = isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant)
        if isinstance(node, ast.Assign | ast.AnnAssign) and is_text and isinstance(below.value.value, str):
            yield node, inspect.cleandoc(below.value.value)


def bullet(head: str, text: str) -> list[str]:
    return textwrap.wrap(f"{head}: {' '.join(text.split())}", WIDTH, initial_indent="- ", subsequent_indent="  ")


def arguments(of: ast.arguments) -> list[str]:
    """The arguments of a function but for the object itself, with their types and defaults."""

    def text(argument: ast.arg, default: ast.expr | None) -> str:
        return ast.unparse(argument) + ("" if default is None else f" = {ast.unparse(default)}")

    none = [None] * (len(of.args) - len(of.defaults))
    plain = [text(*pair) for pair in zip(of.args, none + of.defaults) if pair[0].arg not in ("self", "cls")]
    rest = [f"*{ast.unparse(of.vararg)}"] if of.vararg else ["*"] if of.kwonlyargs else []
    named = [text(*pair) for pair in zip(of.kwonlyargs, of.kw_defaults)]
    return plain + rest + named + ([f"**{ast.unparse(of.kwarg)}"] if of.kwarg else [])


def signature(node: ast.FunctionDef, name: str) -> list[str]:
    """A call with its types; a long one has a line for each argument."""
    end = f") -> {ast.unparse(node.returns)}" if node.returns else ")"
    given = arguments(node.args)
    line = f"{name}({', '.join(given)}{end}"
    lines = [line] if len(line) < WIDTH else [f"{name}(", *(f"    {one}," for one in given), end]
    return ["```python", *lines, "```"]


def function(node: ast.FunctionDef, name: str, level: str) -> list[str]:
    return [f"{level} `{name}`", "", *signature(node, name), "", ast.get_docstring(node) or "", ""]


def kind(node: ast.ClassDef, name: str) -> list[str]:
    lines = [f"### `{name}`", "", ast.get_docstring(node) or "", ""]
    for field, text in documented(node.body):
        target = field.targets[0] if isinstance(field, ast.Assign) else field.target
        if not ast.unparse(target).startswith("_"):
            lines += bullet(f"`{ast.unparse(target)}`", text)
    methods = [member for member in node.body if isinstance(member, ast.FunctionDef)]
    decorators = {id(member): [ast.unparse(of) for of in member.decorator_list] for member in methods}
    public = [member for member in methods if not member.name.startswith("_") and ast.get_docstring(member)]
    properties = [member for member in public if "property" in decorators[id(member)]]
    for member in properties:
        lines += bullet(f"`{member.name}`", ast.get_docstring(member) or "")
    lines += [""] if lines[-1] else []
    others = [member for member in public if member not in properties]
    for member in others:
        if not any(of.endswith(".setter") for of in decorators[id(member)]):
            lines += function(member, f"{name}.{member.name}", "####")
    return lines


def entry(node: ast.stmt, name: str, text: str) -> list[str]:
    if isinstance(node, ast.ClassDef):
        return kind(node, name)
    if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
        return function(node, name, "###")
    return [f"### `{name}`", "", text, ""]


def entries(tree: ast.Module, names: list[str], prefix: str) -> list[str]:
    """What a module says of those of the names that it defines."""
    lines: list[str] = []
    there: dict[str, tuple[ast.stmt, str]] = {node.name: (node, "") for node in tree.body if isinstance(node, Named)}
    for node, text in documented(tree.body):
        target = node.targets[0] if isinstance(node, ast.Assign) else node.target
        there[ast.unparse(target)] = (node, text)
    for name, (node, text) in there.items():
        if name in names:
            lines += entry(node, prefix + name, text)
    return lines


def page() -> str:
    names = names_of(parsed("__init__"))
    lines = [HEAD]
    for chapter, modules in CHAPTERS.items():
        lines += [f"## {chapter}", ""]
        for module in modules:
            lines += entries(parsed(module), names, "enmm.")
    for module in MODULES:
        tree = parsed(module)
        lines += [f"## `enmm.{module}`", "", ast.get_docstring(tree) or "", ""]
        parts = [parsed(f"{module}/{part.stem}") for part in sorted((PACKAGE / module).glob("_[!_]*.py"))] or [tree]
        for part in parts:
            lines += entries(part, names_of(tree), f"enmm.{module}.")
    text = "\n".join(lines)
    while "\n\n\n" in text:
        text = text.replace("\n\n\n", "\n\n")
    return text.rstrip() + "\n"


def test_the_page_of_the_api_is_that_of_the_docstrings():
    made = page()
    if os.environ.get("ENMM_WRITE_API"):
        PAGE.write_text(made, encoding="utf-8")
    assert PAGE.read_text(encoding="utf-8") == made, "run `cargo xtask api`"


def test_every_public_name_is_on_the_page():
    named = {line.split("`")[1] for line in page().splitlines() if line.startswith("### ")}
    missing = [name for name in names_of(parsed("__init__")) if f"enmm.{name}" not in named]
    assert missing == ["ABI_VERSION", "__version__"], "numbers that need no words"
