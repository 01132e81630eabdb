#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs a program by the Python of the documentation, where tools/lib.sh has installed it; else it is skipped (status 77)
# unless TWINRAY_REQUIRE names docs.
# Usage: with_docs_python.sh FILE [ARGUMENT]...
set -euo pipefail
python=$(dirname "${BASH_SOURCE[0]}")/../../build/docs/venv/bin/python
if [[ ! -x $python && ${TWINRAY_REQUIRE-} != *docs* ]]; then
    echo "$python is not there; tools/docs.sh installs it"
    exit 77
fi
exec "$python" "$@"
