#!/usr/bin/env python3
"""What `twinray` says of itself, without a device. Usage: cli_command_test.py TWINRAY"""
import functools
import pathlib
import re
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import command
from command import here, program as twinray

run = functools.partial(command.run, one_stream=True)

commands = re.findall(r"^    ([a-z]+)  ", run("help"), re.M)
assert {"trace", "devices", "verify", "viewfactors", "help", "completion"} <= set(commands), commands

# The list.
assert run("--help") == run("-h") == run("help") == run(status=2)
assert run("--version").startswith("twinray ")

# Each help is a man page: sections in order, lines that fit, an example of the command, no types of a parser.
for command in commands:
    text = run(command, "--help")
    assert text == run("help", command) == run(command, "-h")
    headings = re.findall(r"^[A-Z].*", text, re.M)
    assert headings == ["NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "EXAMPLES", "EXIT STATUS", "ENVIRONMENT"], headings
    assert not re.search(r"ENUM|value in|TEXT:|UINT|FLOAT|\{", text), text
    assert re.search(rf"EXAMPLES\n(?:.*\n)*?.*twinray {command} ?", text), command
    words = "EXAMPLES\n" + text.split("EXAMPLES\n")[1].split("EXIT STATUS")[0]
    for line in text.replace(words, "").splitlines():
        assert len(line) <= 80 or " " not in line.strip(), line
    for status in "012":
        assert re.search(rf"^    {status}$", text, re.M), f"{command}: exit status {status} is not told"

# An option has one meaning, default and set of choices everywhere; these differ, and their helps say how.
differ = {"--sides", "--suite", "--grid", "--levels", "--output", "--width", "--random", "--up"}
seen = {}
for command in commands:
    for head, help in re.findall(r"^    ((?:-\w, )?--.*)\n((?:            .*\n)+)", run(command, "--help"), re.M):
        name, default = re.search("--[a-z-]+", head)[0], re.search(r"default: ([^)]*)\)$", " ".join(help.split()))
        meant = (head, default and default[1])
        if name not in differ:
            assert seen.setdefault(name, meant) == meant, (command, name, meant, seen[name])
assert seen["--accel"] == ("--accel auto|sw|hw", "auto"), seen["--accel"]

# Wrong use: status 2, and what was meant.
for arguments, words in [
        (["frob"], "there is no command 'frob', but view, trace, devices,"), (["viewf"], "did you mean view"),
        (["trase"], "there is no command 'trase'; did you mean trace? See 'twinray help'"),
        (["help", "trase"], "must be view, trace, devices"), (["help", "trase"], "did you mean trace?"),
        (["trace", "a.ply", "--ray", "r"], "there is no option --ray; did you mean --rays?"),
        (["trace", "a.ply"], "--rays is required"), (["trace"], "SCENE is required"),
        (["trace", "a.ply", "--rays", "r", "--hits"], "--hits needs FILE, but nothing follows"),
        (["trace", "a.ply", "--rays", "r", "--hits", "h", "--accel", "gpu"], "--accel is 'gpu', but must be auto, sw or hw"),
        (["trace", "a.ply", "--rays", "r", "--hits", "h", "--level", "wet"],
         "--level is 'wet', but must be fast, watertight, refined or certified"),
        (["trace", "a.ply", "--rays", "r", "--hits", "h", "--query", "all", "--counts", "c", "--level", "refined"],
         "--query all requires --level watertight"),
        (["illumination", "a.ply", "--direction", "0", "0", "1", "--grid", "0"],
         "--grid is '0', but must be a whole number from 1 to 65535"),
        (["completion", "tcsh"], "must be bash, zsh or fish"), (["completion"], "SHELL is required"),
        (["help", "trace", "--man", "-o", "x"], "--output excludes COMMAND")]:
    said = run(*arguments, status=2)
    assert words in said and said.count("\n") == 1, said
    assert "--help'" in said or "help'" in said, said
# A failure of the world: status 1, one line.
said = run("trace", "none.ply", "--rays", "r", "--hits", "h", status=1)
assert "none.ply" in said and said.count("\n") == 1, said

# Man pages.
run("help", "--man", "-o", "man1")
pages = sorted(page.name for page in (here / "man1").iterdir())
assert pages == sorted(["twinray.1", *(f"twinray-{command}.1" for command in commands)]), pages
assert (here / "man1/twinray-trace.1").read_text() == run("help", "trace", "--man")
assert (here / "man1/twinray.1").read_text() == run("help", "--man")
if shutil.which("groff"):
    for page in pages:
        done = subprocess.run(["groff", "-ww", "-z", "-man", "-Tutf8", here / "man1" / page], capture_output=True, text=True)
        assert done.returncode == 0 and not done.stderr, done.stderr

# Completion.
for shell in ["bash", "zsh", "fish"]:
    script = here / f"script.{shell}"
    run("completion", shell, "-o", script.name)
    assert script.read_text() == run("completion", shell)
    if shutil.which(shell):
        subprocess.run([shell, "-n", script], check=True)


def bash(*words):
    """What bash offers for the last word."""
    tell = f"""source {here}/script.bash; COMP_WORDS=({' '.join(repr(word) for word in words)})
               COMP_CWORD=$(({len(words)} - 1)); _twinray; printf '%s\\n' "${{COMPREPLY[@]}}" """
    done = subprocess.run(["bash", "-c", tell], capture_output=True, text=True, cwd=here)
    assert not done.stderr, done.stderr
    return done.stdout.split()


# Output that cannot be printed is a failure.
for arguments in (["--help"], ["--version"], ["help", "trace"], ["completion", "bash"]):
    with open("/dev/full", "w") as full:
        done = subprocess.run([twinray, *arguments], stdout=full, stderr=subprocess.PIPE, text=True)
    assert done.returncode == 1 and "the standard output cannot be written" in done.stderr, (arguments, done)

if shutil.which("bash"):
    assert bash("twinray", "") == [*commands, "--help", "--version"]
    assert bash("twinray", "tr") == ["trace"]
    assert bash("twinray", "trace", "--l") == ["--level", "--labels"]
    assert bash("twinray", "trace", "--accel", "") == ["auto", "sw", "hw"]
    assert bash("twinray", "trace", "--accel", "=", "a") == ["auto"]
    assert bash("twinray", "trace", "man") == ["man1"], "a file"
    assert bash("twinray", "report", "--levels", "fast,w") == ["fast,watertight"]
    assert bash("twinray", "help", "tr") == ["trace"]
    assert bash("twinray", "completion", "z") == ["zsh"]
    assert bash("twinray", "frob", "") == []
shutil.rmtree(here)
print("cli: the command tells all of itself")
