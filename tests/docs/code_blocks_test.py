#!/usr/bin/env python3
"""code_blocks.py sees what it must: each of these pages has one fault, but for the last.
Usage: code_blocks_test.py; exits with 77 where markdown-it-py is not installed."""

import contextlib
import io
import pathlib
import sys
import tempfile

import code_blocks

FAULTY = {
    "a fence without a language": ("```\nls\n```\n", "without a language"),
    "a language that is not run": ("```rust\nfn main() {}\n```\n", "neither run nor says not-run"),
    "no reason": ('```cpp not-run="later"\nint i;\n```\n', "wants a reason"),
    "an unknown option": ('```sh skip="it is slow"\nls\n```\n', "no option 'skip'"),
    "an indented block": ("text\n\n    ls\n", "indented"),
    "a command that fails": ("```sh\ntest -e nothing.txt\n```\n", "exit status 1"),
    "a failure within a line": ("```sh\nfalse | cat\n```\n", "exit status 1"),
    "a command that should fail": ("```sh exit=3\ntrue\n```\n", "not 3"),
    "other output": ("```console\n$ echo one\ntwo\n```\n", "where the page has"),
    "a line that is not printed": ('```text printed-by="seq 3"\n1\n3\n```\n', "where the page has"),
    "a need that nobody knows": ('```sh needs="luck"\ntrue\n```\n', "needs 'luck'"),
    "an option of mere text": ('```text needs="radv"\n1\n```\n', "text has printed-by"),
    "a fault in an admonition": ("````{note}\n```sh\nfalse\n```\n````\n", "page.md:2: exit status 1"),
    "code that Sphinx alone sees": ("```{code-block} sh\nfalse\n```\n", "fence it"),
    "Python that fails": ("```python\nassert 1 == 2\n```\n", "AssertionError"),
    "a session with another answer": ("```pycon\n>>> 1 + 1\n3\n```\n", "Expected"),
    "C++ that is none": ("```cpp\nint main() { return nothing; }\n```\n", "nothing"),
}
RIGHT = """```sh
echo 7 > seven.txt
```
```console
$ cat seven.txt
7
$ echo one two three
one ... three
```
```python
assert open("seven.txt").read() == "7\\n"
```
```pycon
>>> 1 + 1
2
```
```text printed-by="echo one; echo two three"
one
two ...
```
```cpp
int main() {}
```
```sh exit=1
false
```
```cpp not-run="needs a window of yours"
window.show();
```
"""


def told(text):
    """The exit status for a page, and what is printed."""
    with tempfile.TemporaryDirectory() as folder:
        page = pathlib.Path(folder) / "page.md"
        page.write_text(text, encoding="utf-8")
        printed = io.StringIO()
        with contextlib.redirect_stdout(printed):
            status = code_blocks.main(["--programs", folder, "--package", folder, "--root", folder, "page.md"])
        return status, printed.getvalue()


def main():
    wrong = []
    for name, (text, words) in FAULTY.items():
        status, printed = told(text)
        if status != 1 or words not in printed or ", 1 faults" not in printed:
            wrong.append(f"{name}: status {status}: {printed}")
    status, printed = told(RIGHT)
    if status != 0 or "7 blocks run" not in printed:
        wrong.append(f"a page without a fault: status {status}: {printed}")
    print("\n".join(wrong) or f"code_blocks_test: {len(FAULTY)} faults seen, and a page without one")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
