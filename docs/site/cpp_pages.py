# SPDX-License-Identifier: MIT
"""Pages of the C++ reference: one for each header, which Breathe fills from Doxygen's XML."""

SECTIONS = (
    "briefdescription detaileddescription define enum func innerclass public-attrib public-func public-static-attrib "
    "public-static-func public-type typedef user-defined var"
)
# In the order in which one meets them.
ORDER = ("geometry", "trace", "abstract_accel", "tlas", "context", "commands", "device_mesh", "world", "scene", "sets",
         "queries", "analysis", "validation", "vma_adapter")  # fmt: skip


def first_sentence(header):
    lines = header.read_text(encoding="utf-8").split("\n")[1:]
    text = ""
    for line in lines:
        if not line.startswith("// ") or line.startswith("//  "):
            break
        text += line.removeprefix("//")
    return text.strip().split(". ")[0].rstrip(".") + "."


def page_of(name):
    return f"# `<twinray/{name}.h>`\n\n```{{doxygenfile}} {name}.h\n:sections: {SECTIONS}\n```\n"


def index_of(introduction, rows, names):
    """A page that lists headers in a table and leads to their pages."""
    table = "| header | what is there |\n|---|---|\n" + "\n".join(rows)
    return f"{introduction}\n\n{table}\n\n```{{toctree}}\n:hidden:\n\n" + "\n".join(names) + "\n```\n"


def write(folder, headers):
    folder.mkdir(parents=True)
    names = sorted(
        (header.stem for header in headers.glob("*.h") if header.stem != "twinray"),
        key=lambda name: (ORDER.index(name) if name in ORDER else len(ORDER), name),
    )
    rows = [f"| [`<twinray/{name}.h>`]({name}.md) | {first_sentence(headers / f'{name}.h')} |" for name in names]
    introduction = (
        "# C++\n\nWhat `include/twinray` declares in namespace `twinray`, from its comments. "
        "`<twinray/twinray.h>` includes what traces rays."
    )
    (folder / "index.md").write_text(index_of(introduction, rows, names), encoding="utf-8")
    for name in names:
        (folder / f"{name}.md").write_text(page_of(name), encoding="utf-8")
