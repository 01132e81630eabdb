#!/usr/bin/env python3
"""Fails for each public type, function and macro without documentation, and names it: of C++ and GLSL by Doxygen's XML
of the headers, of Python by docstrings.
Usage: reference_test.py ROOT; exits with 77 where Doxygen is not installed."""

import ast
import pathlib
import shutil
import subprocess
import sys
import tempfile

root = pathlib.Path(sys.argv[1])
sys.path.insert(0, str(root / "docs/site"))
import reference_pages as pages  # noqa: E402

KINDS = {"function", "enum", "typedef", "define"}


def needs_words(member):
    """Not what every type has: copies, moves, comparisons and destructors."""
    name, arguments = member.findtext("name"), member.findtext("argsstring") or ""
    is_special = name.startswith(("~", "operator=")) or arguments.endswith(("=default", "=delete"))
    is_move = f"({name} &&" in arguments.split(",")[0]
    return member.get("kind") in KINDS and member.get("prot") == "public" and not is_special and not is_move


def header_of(node):
    return (
        node.find("location").get("file").removeprefix(f"{root}/")
    )  # lines are those of Doxygen's input, not of the file


def undocumented(folder):
    for compound in pages.compounds(folder):
        name = compound.findtext("compoundname")
        if compound.get("prot") == "private" or pages.NOT_FOR_KERNELS & {pathlib.Path(name).name}:
            continue
        if compound.get("kind") in ("class", "struct", "file") and not pages.is_documented(compound):
            yield f"{header_of(compound)}: {compound.get('kind')} {name}"
        for member in compound.iter("memberdef"):
            if pages.is_guard(member) or pages.is_own(member) or not needs_words(member):
                continue
            if not pages.is_documented(member):
                yield f"{header_of(member)}: {member.get('kind')} {name}: {pages.signature(member)}"


def undocumented_python(package):
    for file in sorted(package.glob("*.py")):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        if not ast.get_docstring(tree) and not file.stem.startswith("_"):
            yield f"{file.relative_to(root)}:1 module {file.stem}"
        if file.stem.startswith("_") and file.stem != "__init__":
            continue
        for node in tree.body:
            below = node.body if isinstance(node, ast.ClassDef) else []
            for item in [node, *below]:
                is_public = isinstance(item, ast.ClassDef | ast.FunctionDef) and not item.name.startswith("_")
                if is_public and not node.name.startswith("_") and not ast.get_docstring(item):
                    yield f"{file.relative_to(root)}:{item.lineno} {item.name}"


def main():
    if not shutil.which("doxygen"):
        print("doxygen is not installed")
        return 77
    found = list(undocumented_python(root / "bindings/python/twinray"))
    with tempfile.TemporaryDirectory() as folder:
        for language in ("cpp", "glsl"):
            target = pathlib.Path(folder) / language
            subprocess.run([root / "docs/site/doxygen.sh", language, target], check=True)
            found += undocumented(target / "xml")
    for line in sorted(set(found)):
        print(f"without documentation: {line}")
    print(f"{len(set(found))} names without documentation")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
