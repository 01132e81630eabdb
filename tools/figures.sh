#!/usr/bin/env bash
# Makes docs/figures/NAME.svg of docs/figures/NAME.dot. Needs dot, of graphviz.
#   tools/figures.sh            writes them
#   tools/figures.sh --check    writes nothing; exit 1 if a picture and its text differ, 77 without dot
# Coordinates are not compared: they depend on the version of dot and on the fonts that it finds.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../docs/figures"

if ! command -v dot >/dev/null; then
    echo "figures: dot is missing (Debian: apt-get install graphviz)" >&2
    exit 77
fi

# Names of nodes, of edges and of what is drawn around them, and all words, in their order.
words() { sed -nE 's/.*<title>(.*)<\/title>.*/\1/p; s/.*<text [^>]*>(.*)<\/text>.*/  \1/p' "$1"; }

status=0
new=$(mktemp)
trap 'rm -f "$new"' EXIT
for text in *.dot; do
    picture=${text%.dot}.svg
    dot -Tsvg "$text" -o "$new"
    if [[ ${1-} != --check ]]; then
        sed '/^<!--.*-->$/d; s/[ \t]*$//' "$new" >"$picture" # its titles repeat the comments
    elif [[ ! -e $picture ]] || ! diff <(words "$picture") <(words "$new"); then
        echo "figures: docs/figures/$picture is not what docs/figures/$text says; run tools/figures.sh" >&2
        status=1
    fi
done
for picture in *.svg; do
    if [[ ! -e ${picture%.svg}.dot ]]; then
        echo "figures: docs/figures/$picture has no .dot" >&2
        status=1
    fi
done
exit $status
