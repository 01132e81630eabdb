#!/usr/bin/env python3
"""Follows every link of a built site that stays within it, to its file and its anchor, and lists the others.
Usage: check_links.py FOLDER FILE   FILE: becomes the list of links to elsewhere, which are not fetched
Prints "broken links 0"; or each broken one on standard error, and exits with 1."""

import html.parser
import pathlib
import sys
import urllib.parse


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.anchors, self.links = {"", "top"}, []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name") and value:
                self.anchors.add(value)
            if name in ("href", "src") and value is not None and (tag, name) != ("link", "data"):
                self.links.append(value)


def check(folder):
    pages = {file.resolve(): Page(file.read_text(encoding="utf-8")) for file in sorted(folder.rglob("*.html"))}
    broken, external = [], set()
    for file, page in pages.items():
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme or parts.netloc:
                external.add(link)
                continue
            target = (file.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else file
            if target.is_dir():
                target /= "index.html"
            anchor = urllib.parse.unquote(parts.fragment)
            if not target.is_file() or (target in pages and anchor not in pages[target].anchors):
                broken.append(f"{file.relative_to(folder.resolve())}: {link}")
    return broken, sorted(link for link in external if not link.startswith("data:"))


def main(folder, list_file):
    broken, external = check(folder)
    list_file.write_text("".join(link + "\n" for link in external), encoding="utf-8")
    for link in broken:
        print(f"check_links: broken: {link}", file=sys.stderr)
    print(f"broken links {len(broken)}")
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])))
