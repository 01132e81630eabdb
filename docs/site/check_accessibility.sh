#!/usr/bin/env bash
# Looks at pages of the built site in a browser, by check_accessibility.mjs. Needs chromium and npm, which fetches two
# packages the first time.
# Usage: check_accessibility.sh FOLDER
set -euo pipefail
site=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
html=$(realpath "$1")
folder=$site/../../build/docs/axe
packages=(puppeteer-core@24.10.0 axe-core@4.10.3)

mkdir -p "$folder"
cd "$folder"
if [[ "$(cat installed.txt 2>/dev/null)" != "${packages[*]}" ]]; then
    npm install --silent --no-fund --no-audit --no-save --prefix . "${packages[@]}"
    echo "${packages[*]}" >installed.txt
fi
cp "$site/check_accessibility.mjs" . # so that it finds the packages
node check_accessibility.mjs "$html" "$(command -v chromium)"
