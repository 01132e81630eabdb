#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# The documentation site builds without a warning, where what it is built with is installed: nothing is fetched here.
# Usage: site_test.sh TWINRAY
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

if ! command -v doxygen >/dev/null || ! cmp -s docs/site/requirements.txt build/docs/venv/installed.txt; then
    echo "Doxygen or Sphinx is not installed; tools/docs.sh installs both"
    exit 77
fi
TWINRAY=$1 SKIP_APT=1 tools/docs.sh
