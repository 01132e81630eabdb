# SPDX-License-Identifier: MIT
"""Pages of the command's reference: what `twinray help COMMAND` prints, one for each command."""

import pathlib
import re
import subprocess

NO_COMMAND = """# Commands

This site was built without the command `twinray`, whose help makes these pages. Build it and the site again:

    cmake --preset release && cmake --build --preset release --target twinray_cli
    tools/docs.sh

What all commands share is told in [the command line](../../command.md).
"""


def help_of(twinray, *command):
    result = subprocess.run([twinray, "help", *command], capture_output=True, text=True, check=True)
    return result.stdout.rstrip()


def names_of(overview):
    """The commands that an overview lists: those of its lines that are indented by four."""
    return re.findall(r"^    ([a-z]+)  +\S", overview, re.M)


def write(folder, twinray):
    folder.mkdir(parents=True)
    if not pathlib.Path(twinray).is_file():
        (folder / "index.md").write_text(NO_COMMAND, encoding="utf-8")
        return
    overview = help_of(twinray)
    names = names_of(overview)
    (folder / "index.md").write_text(
        f"# Commands\n\n```text\n{overview}\n```\n\nWhat they share: [the command line](../../command.md).\n\n"
        "```{toctree}\n:maxdepth: 1\n\n" + "\n".join(names) + "\n```\n",
        encoding="utf-8",
    )
    for name in names:
        page = f"# `twinray {name}`\n\n```text\n{help_of(twinray, name)}\n```\n"
        (folder / f"{name}.md").write_text(page, encoding="utf-8")
