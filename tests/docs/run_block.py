# SPDX-License-Identifier: MIT
"""Runs or compiles one block of code, or looks for its lines in what a command prints; what went wrong is text."""

import doctest
import os
import re
import subprocess

import blocks

SECONDS = 240
SEE_THE_TREE = {"containers", "suite"}  # wraps of C++ that include more than what is installed


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


def wrapped(block, tools):
    """What is compiled: the block, or its wrap with it; `#include` lines go where that has INCLUDES. Messages name the
    page's lines."""
    name = block.options.get("wrap")
    if name is None:
        return block.text
    wrap = (tools.wraps / f"{name}.{block.language}").read_text(encoding="utf-8")
    lines, includes = block.text.splitlines(), []
    if "INCLUDES\n" in wrap:
        includes = [line for line in lines if line.startswith("#include")]
        lines = ["" if line.startswith("#include") else line for line in lines]
        wrap = wrap.replace("INCLUDES\n", "\n".join([*includes, ""]))
    return wrap.replace("BLOCK", "\n".join([f'\n#line {block.line + 1} "page"', *lines, ""]))


def compile_cpp(block, folder, tools):
    folders = [tools.root / "include", tools.wraps]
    if block.options.get("wrap") in SEE_THE_TREE:
        folders.append(tools.root)
    command = ["g++", "-std=c++20", "-fsyntax-only", *[f"-I{folder}" for folder in folders], "-x", "c++", "-"]
    return run(command, folder, tools, text=wrapped(block, tools))[1]


def compile_glsl(block, folder, tools):
    for accelerator in ("SW", "HW"):
        command = ["glslangValidator", "--target-env", "vulkan1.2", f"-DTWINRAY_{accelerator}"]
        command += [f"-I{tools.root / folder}" for folder in ("", "include", "shaders")]
        command += [f"-I{tools.wraps}", "--stdin", "-S", "comp"]
        fault = run(command, folder, tools, text=wrapped(block, tools))[1]
        if fault:
            return f"with TWINRAY_{accelerator}: {fault}"
    return ""


def can_run(block, folder, tools):
    """Whether what the block needs is there."""
    needs = block.options.get("needs")
    if needs not in tools.found:
        tools.found[needs] = needs is None or not run_shell(blocks.NEEDS[needs], folder, tools)[1]
    return tools.found[needs]


def printed_once(command, folder, tools):
    """What a command prints, which a page runs but once, and what is wrong."""
    known = tools.printed.setdefault(folder, {})
    if command not in known:
        known[command] = run_shell(command, folder, tools)
    return known[command]


def find_lines(block, folder, tools):
    command = block.options["printed-by"]
    printed, fault = printed_once(command, folder, tools)
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
