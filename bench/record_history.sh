#!/usr/bin/env bash
# Measures the scenes that history is kept of and appends the records to FOLDER/<device>.jsonl, one JSON object a line,
# with date, revision and driver. Nothing is appended unless all scenes were measured.
#   bench/record_history.sh [-t TWINRAY] [-o FOLDER] [SCENE...] [-- OPTION...]
# TWINRAY is build/release/bin/twinray, FOLDER bench/history unless given; each OPTION goes to `twinray bench`.
set -euo pipefail
here=$(dirname "${BASH_SOURCE[0]}")
twinray=$here/../build/release/bin/twinray
folder=$here/history
scenes=()
while (($#)); do
    case $1 in
    -t) twinray=$2 && shift 2 ;;
    -o) folder=$2 && shift 2 ;;
    --) shift && break ;;
    -*) sed -n '2,5s/^# *//p' "${BASH_SOURCE[0]}" >&2 && exit 2 ;;
    *) scenes+=("$1") && shift ;;
    esac
done
if ((${#scenes[@]} == 0)); then scenes=(sphere:10000 sphere:100000 sphere:1310720 soup:1000000 instances:1000x5120); fi

records=$(mktemp)
trap 'rm -f "$records"' EXIT
for scene in "${scenes[@]}"; do "$twinray" bench --scene "$scene" --json "$records" "$@"; done

slug=$(python3 -c 'import json, re, sys; name = json.loads(open(sys.argv[1]).readline())["device"]["name"]
print(re.sub("[^a-z0-9]+", "-", name.lower()).strip("-"))' "$records")
mkdir -p "$folder"
cat "$records" >>"$folder/$slug.jsonl"
echo "appended $(wc -l <"$records") records to $folder/$slug.jsonl"
