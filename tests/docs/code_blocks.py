#!/usr/bin/env python3
"""Runs what the README and the pages of docs/ show, or finds in its fence why not.
Usage: code_blocks.py --programs FOLDER --package FOLDER [--root FOLDER] [PAGE...]
  --programs   where twinray and path_tracer are        --package      where the Python package is
  --python     which Python runs blocks; it has what the package needs

```sh                          commands, run by bash in a folder that the blocks of a page share
```sh exit=1                   they end with this status
```console                     `$ ` begins a command, the lines below it are what it prints; `...` stands for anything
```python                      run by itself; `pycon` is a session, checked as doctest does
```cpp                         a whole file, compiled
```glsl wrap="kernel"          compiled in place of BLOCK in the wrap of that name: wraps.py
```sh not-run="needs a GPU"    and why
```text printed-by="COMMAND"   lines that it prints, one below the other, with `...` for anything; a page runs it once
```sh needs="radv"               run where there is such (NEEDS); of any language
```text                        else is no code, as are csv, json and what Sphinx makes of itself (`{...}`)

Files that pages take for given are in their folder: given.py.
"""

import argparse
import dataclasses
import doctest
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

try:
    import markdown_it
except ModuleNotFoundError as error:
    print(f"{error}: tools/docs.sh installs it into build/docs/venv")
    sys.exit(77)
import given
import wraps

ELSEWHERE = ["README.md", "CONTRIBUTING.md", "samples/README.md"]  # also on the site
SECONDS = 240
NO_CODE = {"text", "csv", "json"}
RUN = {"sh", "console", "python", "pycon", "cpp", "glsl", "text"}
OPTIONS = {"not-run": RUN - {"text"} | {"cmake"}, "exit": {"sh"}, "wrap": {"cpp", "glsl"}}
OPTIONS |= {"printed-by": {"text"}, "needs": RUN}
# The needs of blocks, with the command that succeeds if they are met.
NEEDS = {
    "dask": "python3 -c 'import dask.distributed, matplotlib, rioxarray'",
    "llvmpipe": "twinray devices | grep -q '^[*].*llvmpipe'",
    "radv": "twinray kernels --family navi31 --filter sort_scan",
    "nvk": "twinray kernels --family ampere --filter sort_scan",
}
CODE_OF_SPHINX = {"{code}", "{code-block}", "{sourcecode}"}
OPTION = re.compile(r'([\w-]+)=(?:"([^"]*)"|(\S+))')


@dataclasses.dataclass
class Block:
    """A block of code, and where it begins."""

    language: str
    options: dict
    text: str
    line: int
    fault: str = ""

    @property
    def is_run(self):
        return self.language in RUN and "not-run" not in self.options and not self.fault


def fault_of(language, rest, options):
    """What is wrong with an info string, "" if nothing is."""
    if not language:
        return "a fence without a language; text is one"
    if left := OPTION.sub("", rest).strip():
        return f"'{left}' is not of the form option=value"
    for name, value in options.items():
        if language not in OPTIONS.get(name, ()):
            return f"no option '{name}' for '{language}'"
        if name == "needs" and value not in NEEDS:
            return f"needs '{value}', which is none of {', '.join(NEEDS)}"
        if name == "not-run" and len(value.split()) < 2:
            return "not-run wants a reason"
    if language == "text" and "printed-by" not in options:
        return "text has printed-by, or no option"
    if language not in RUN and "not-run" not in options:
        return f"'{language}' is neither run nor says not-run"
    return ""


def blocks_of(text, lines_above=0):
    """Every block of code of a page. Those that are indented have no language: fence them."""
    found = []
    for token in markdown_it.MarkdownIt().parse(text):
        line = token.map[0] + 1 + lines_above if token.map else 0
        if token.type == "code_block":
            found.append(Block("", {}, token.content, line, "an indented block; fence it"))
        if token.type != "fence":
            continue
        language, _, rest = token.info.strip().partition(" ")
        if language in CODE_OF_SPHINX:
            found.append(Block("", {}, token.content, line, f"{language} is not looked into; fence it"))
        elif language.startswith("{") and language != "{eval-rst}":
            found += blocks_of(token.content, line)  # an admonition holds Markdown
        elif not language.startswith("{") and (language not in NO_CODE or rest):
            options = {name: quoted or bare for name, quoted, bare in OPTION.findall(rest)}
            found.append(Block(language, options, token.content, line, fault_of(language, rest, options)))
    return found


def run(command, folder, tools, wanted_status=0, text=None):
    """What a command prints, and what is wrong."""
    environment = os.environ | {
        "PATH": f"{tools.programs}:{os.environ['PATH']}",
        "PYTHONPATH": str(tools.package),
    }
    try:
        result = subprocess.run(
            command, cwd=folder, env=environment, input=text, capture_output=True, text=True, timeout=SECONDS
        )
    except subprocess.TimeoutExpired:
        return "", f"ran for more than {SECONDS} s"
    if result.returncode != wanted_status:
        return result.stdout, f"exit status {result.returncode}, not {wanted_status}:\n{result.stdout}{result.stderr}"
    return result.stdout, ""


def run_shell(text, folder, tools, wanted_status=0):
    return run(["bash", "-euo", "pipefail", "-c", text], folder, tools, wanted_status)


def run_sh(block, folder, tools):
    return run_shell(block.text, folder, tools, int(block.options.get("exit", 0)))[1]


def run_console(block, folder, tools):
    for part in re.split(r"^\$ ", block.text, flags=re.M)[1:]:
        command, _, wanted = part.partition("\n")
        printed, fault = run_shell(command, folder, tools)
        if fault:
            return f"{command}: {fault}"
        if wanted.strip() and not doctest.OutputChecker().check_output(wanted, printed, doctest.ELLIPSIS):
            return f"{command}: printed\n{printed}where the page has\n{wanted}"
    return ""


def run_python(block, folder, tools):
    return run([tools.python, "-W", "ignore", "-"], folder, tools, text=block.text)[1]


def run_session(block, folder, tools):
    with open(folder / "session.txt", "a", encoding="utf-8") as file:  # the sessions of a page go on
        file.write(block.text + "\n")
    options = ["-o", "ELLIPSIS", "-o", "NORMALIZE_WHITESPACE"]
    return run([tools.python, "-W", "ignore", "-m", "doctest", *options, "session.txt"], folder, tools)[1]


def wrapped(block):
    """What is compiled: the block, or its wrap with it; `#include` lines go where that has INCLUDES. Messages name the
    page's lines."""
    name = block.options.get("wrap")
    if name is None:
        return block.text
    wrap = wraps.WRAPS[block.language][name]
    lines, includes = block.text.splitlines(), []
    if "INCLUDES\n" in wrap:
        includes = [line for line in lines if line.startswith("#include")]
        lines = ["" if line.startswith("#include") else line for line in lines]
        wrap = wrap.replace("INCLUDES\n", "\n".join([*includes, ""]))
    return wrap.replace("BLOCK", "\n".join([f'\n#line {block.line + 1} "page"', *lines, ""]))


def compile_cpp(block, folder, tools):
    folders = [tools.root / "include"]
    if block.options.get("wrap") in wraps.SEE_THE_TREE:
        folders.append(tools.root)
    command = ["g++", "-std=c++20", "-fsyntax-only", *[f"-I{folder}" for folder in folders], "-x", "c++", "-"]
    return run(command, folder, tools, text=wrapped(block))[1]


def compile_glsl(block, folder, tools):
    for accelerator in ("SW", "HW"):
        command = ["glslangValidator", "--target-env", "vulkan1.2", f"-DTWINRAY_{accelerator}", "--stdin", "-S", "comp"]
        command += [f"-I{tools.root / folder}" for folder in ("", "include", "shaders")]
        if fault := run(command, folder, tools, text=wrapped(block))[1]:
            return f"with TWINRAY_{accelerator}: {fault}"
    return ""


def can_run(block, folder, tools):
    """Whether what the block needs is there."""
    needs = block.options.get("needs")
    if needs not in tools.found:
        tools.found[needs] = needs is None or not run_shell(NEEDS[needs], folder, tools)[1]
    return tools.found[needs]


def find_lines(block, folder, tools):
    command = block.options["printed-by"]
    if (folder, command) not in tools.printed:  # a page runs it but once
        tools.printed[folder, command] = run_shell(command, folder, tools)
    printed, fault = tools.printed[folder, command]
    lines = [".*".join(re.escape(part) for part in line.split("...")) for line in block.text.splitlines()]
    if not fault and not re.search("^" + "\n".join(lines) + "$", printed, re.M):
        fault = f"printed\n{printed}where the page has\n{block.text}"
    return fault and f"{command}: {fault}"


WAYS = {
    "sh": run_sh,
    "console": run_console,
    "python": run_python,
    "pycon": run_session,
    "cpp": compile_cpp,
    "glsl": compile_glsl,
    "text": find_lines,
}


def pages_of(root):
    return [*ELSEWHERE, *sorted(page.relative_to(root).as_posix() for page in (root / "docs").rglob("*.md"))]


def run_page(tools, page, blocks, folder):
    """What is wrong, and how many blocks were run."""
    faults, count = [], 0
    folder.mkdir()
    given.write(folder)
    for block in blocks:
        if not can_run(block, folder, tools):
            print(f"{page}:{block.line}: not run: no {block.options['needs']} is here")
            continue
        count += 1
        if fault := WAYS[block.language](block, folder, tools):
            faults.append(f"{page}:{block.line}: {fault}")
    return faults, count


def main(arguments):
    parser = argparse.ArgumentParser()
    parser.add_argument("--programs", type=pathlib.Path)
    parser.add_argument("--package", type=pathlib.Path)
    parser.add_argument("--python", default=sys.executable)
    parser.add_argument("--root", type=pathlib.Path, default=pathlib.Path(__file__).resolve().parents[2])
    parser.add_argument("pages", nargs="*")
    tools = parser.parse_args(arguments)
    tools.printed, tools.found = {}, {}
    faults, total = [], 0
    pages = {
        page: blocks_of((tools.root / page).read_text(encoding="utf-8")) for page in tools.pages or pages_of(tools.root)
    }
    with tempfile.TemporaryDirectory() as above:  # each page has a folder
        for number, (page, blocks) in enumerate(pages.items()):
            begin = time.monotonic()
            faults += [f"{page}:{block.line}: {block.fault}" for block in blocks if block.fault]
            to_run = [block for block in blocks if block.is_run]
            found, count = run_page(tools, page, to_run, pathlib.Path(above) / str(number))
            faults += found
            total += count
            if count:
                print(f"{page}: {count} blocks, {len(found)} faults, {time.monotonic() - begin:.1f} s", flush=True)
    print("\n".join([*faults, f"code_blocks: {len(pages)} pages, {total} blocks run, {len(faults)} faults"]))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
