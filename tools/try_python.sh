#!/usr/bin/env bash
# Follows docs/python.md like a user with nothing installed: packages, `pip install .` into a new environment, the
# README's five lines; prints the time of each. For tools/check_clean_room.sh.
#   tools/try_python.sh [FOLDER OF THE ENVIRONMENT]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/lib.sh

folder=${1-$(mktemp -d)}
section "Packages"
tools/setup.sh python
section "pip install ."
python3 -m venv "$folder"
"$folder/bin/pip" install --quiet --disable-pip-version-check .
section "Five lines"
awk '/^```/ { inside = /python/; next } inside' README.md | "$folder/bin/python" -W ignore -
section_end
