# SPDX-License-Identifier: MIT
"""The code blocks of a page of Markdown, and what their info strings say of them.

```sh                          commands, run by bash in a folder that the blocks of a page share
```sh exit=1                   they end with this status
```console                     `$ ` begins a command, the lines below it are what it prints; `...` stands for anything
```python                      run by itself; `pycon` is a session, checked as doctest does
```cpp                         a whole file, compiled
```glsl wrap="kernel"          compiled in place of BLOCK in wraps/kernel.glsl
```sh not-run="needs a GPU"    and why
```text printed-by="COMMAND"   lines that it prints, one below the other, with `...` for anything; a page runs it once
```sh needs="radv"               run where there is such (NEEDS); of any language
```text                        else is no code, as are csv, json and what Sphinx makes of itself (`{...}`)

Files that pages take for given are in their folder: given.py.
"""

import dataclasses
import re

import markdown_it

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
