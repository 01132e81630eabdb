#!/usr/bin/env bash
# Builds the documentation site, without a warning. If the tools for it are not installed, the test is skipped (status
# 77), unless TWINRAY_REQUIRE names docs.
# Usage: site_test.sh TWINRAY
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

has_tools() { command -v doxygen >/dev/null && cmp -s docs/site/requirements.txt build/docs/venv/installed.txt; }
if [[ ${TWINRAY_REQUIRE-} != *docs* ]] && ! has_tools; then
    echo "Doxygen or Sphinx is not installed; tools/docs.sh installs both"
    exit 77
fi
# Other tests run beside it, some of which count seconds.
CMAKE_BUILD_PARALLEL_LEVEL=1 TWINRAY=$1 tools/docs.sh
