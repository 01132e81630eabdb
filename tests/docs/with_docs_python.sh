#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs a program by the Python of the documentation, where tools/docs.sh has installed it.
# Usage: with_docs_python.sh FILE [ARGUMENT]...
set -euo pipefail
python=$(dirname "${BASH_SOURCE[0]}")/../../build/docs/venv/bin/python
if [[ ! -x $python ]]; then
    echo "$python is not there; tools/docs.sh installs it"
    exit 77
fi
exec "$python" "$@"
