#!/usr/bin/env bash
# Runs a program with the documentation's Python if tools/lib.sh has installed it; otherwise skips it (status 77),
# unless TWINRAY_REQUIRE names docs.
# Usage: with_docs_python.sh FILE [ARGUMENT]...
set -euo pipefail
python=$(dirname "${BASH_SOURCE[0]}")/../../build/docs/venv/bin/python
if [[ ! -x $python && ${TWINRAY_REQUIRE-} != *docs* ]]; then
    echo "$python is not there; tools/docs.sh installs it"
    exit 77
fi
exec "$python" "$@"
