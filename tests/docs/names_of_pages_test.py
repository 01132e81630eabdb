#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""names_of_pages.py sees what it must. Usage: names_of_pages_test.py PROGRAMS"""

import pathlib
import sys

import names_of_pages

PAGE = """`twinray verify --nonsense` and `twinray frob`, `SwTlas::store`, `SharedVertices::by_place`, and
`Shared::by_position`; right: `twinray verify --aimed 7`, `SwTlas::save`, `twinray help`,
`path_tracer merge *.film -o FILE`.
`path_tracer SCENE --fames 3`, `--picture-sise W H`

| Embree | twinray |
|---|---|
| `rtcX` | `push_it(mesh)`, `SwTlass`, `closest_hits(rays)` |

```sh not-run="takes too long"
twinray report --siute full
```
"""
WANTED = [
    "page.md:1: 'twinray verify' has no option --nonsense",
    "page.md:1: no command 'twinray frob'",
    "page.md:1: `SwTlas::store`: SwTlas has no store",
    "page.md:1: `SharedVertices::by_place`: SharedVertices has no by_place",
    "page.md:2: `Shared::by_position`: Shared has no by_position",
    "page.md:4: 'path_tracer' has no option --fames",
    "page.md:4: no program has an option --picture-sise",
    "page.md:8: no SwTlass in headers or package",
    "page.md:8: no push_it in headers or package",
    "page.md:10: 'twinray report' has no option --siute",
]


def main():
    public = names_of_pages.Public(names_of_pages.ROOT)
    programs = names_of_pages.Programs(pathlib.Path(sys.argv[1]))
    found = names_of_pages.faults_of("page.md", PAGE, public, programs)
    wrong = [f"not seen: {fault}" for fault in WANTED if fault not in found]
    wrong += [f"no fault: {fault}" for fault in found if fault not in WANTED]
    print("\n".join(wrong) or f"names_of_pages_test: {len(WANTED)} faults seen, and what is right let through")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
