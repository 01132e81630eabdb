#!/usr/bin/env bash
# Measures a GPU in some ten minutes: the contract, verify, report, builds, rays, and the same rays by other packages
# with how many of a million answers are wrong. Prints a table of the parts and writes
#   FOLDER/DEVICE.jsonl          builds and rays of twinray and the driver, appended
#   FOLDER/DEVICE-report.jsonl   the records of the report
#   FOLDER/DEVICE-peers.json     rays beside other packages
#   bench/gpu_day.sh [-b BUILD] [-p PYTHON] [-m MESH] [-c PROGRAMS] [-o FOLDER] [--cuda] [--small]
#     -b BUILD      the build whose programs and tests are run: build/release
#     -p PYTHON     an interpreter with twinray, trimesh and the peers that are installed: python3
#     -m MESH       a closed mesh for verify and rays, beside spheres; none if not given
#     -c PROGRAMS   the programs that bench/peers/programs.sh has made; none if not given
#     -o FOLDER     bench/history
#     --cuda        peers use the GPU
#     --small       a rehearsal: a hundredth of the rays
# It names the parts that are missing and leaves them out.
set -uo pipefail

here=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
build=$here/../build/release python=python3 mesh='' programs='' folder=$here/history
scenes=(sphere:10000 sphere:1310720 instances:1000x500) qualities=fast,high,ploc
width=4096 rays=16777216 random=10000000 aimed=1000000 subdivisions=8 budget=90 peers=(--rounds 5)
while (($#)); do
    case $1 in
    -b) build=$2 && shift ;;
    -p) python=$2 && shift ;;
    -m) mesh=$2 && shift ;;
    -c) programs=$2 && shift ;;
    -o) folder=$2 && shift ;;
    --cuda) peers+=(--cuda) ;;
    --small)
        scenes=(sphere:10000 instances:100x500) qualities=fast
        width=256 rays=100000 random=100000 aimed=10000 subdivisions=6 budget=20
        ;;
    *) sed -n '2,15s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2 && exit 2 ;;
    esac
    shift
done
twinray=$build/bin/twinray
tests=$build/bin/vulkan_tests
if [[ ! -x $twinray ]]; then
    echo "gpu_day: no $twinray: build it first (README)" >&2
    exit 1
fi
logs=$(mktemp -d)
mkdir -p "$folder"
"$twinray" devices --json "$logs/device" >/dev/null || exit 1
device=$("$python" - "$logs/device" <<'PYTHON'
import json, re, sys
print(re.sub("[^a-z0-9]+", "-", json.loads(open(sys.argv[1]).readline())["name"].lower()).strip("-"))
PYTHON
) || exit 1

rows=()
# Runs a part within its time and reports the last line of its output that has the words.
part() { # name, seconds at most, words, command...
    local start=$SECONDS status said log=$logs/${1// /-}
    echo "== $1 =="
    timeout --kill-after=10 "$2" "${@:4}" >"$log" 2>&1
    status=$?
    said=$(grep -E "$3" "$log" | tail -n 1)
    if ((status)); then
        tail -n 5 "$log"
        said="exit status $status; $said"
    fi
    if ((status == 124)); then said="stopped after $2 s; $said"; fi
    rows+=("$(printf '%-16s %5d s  %s' "$1" $((SECONDS - start)) "$said")")
    return "$status"
}
left_out() { rows+=("$(printf '%-16s        left out: %s' "$1" "$2")"); }

if [[ -x $tests ]]; then
    part contract 60 'PASSED|FAILED' "$tests" --gtest_filter='Every/Accel.*:Every/Features.*' --gtest_brief=1
else
    left_out contract "no $tests"
fi
if [[ -n $mesh ]]; then
    part verify 60 'fault' "$twinray" verify "$mesh" --random "$random" --aimed "$aimed" --quiet
else
    left_out verify 'no mesh is given (-m)'
fi
part report $((budget * 3)) 'cases ran' "$twinray" report -o "$logs/page" --budget "$budget" \
    --json "$logs/report.jsonl" --quiet
part 'builds and rays' 150 'appended' "$here/record_history.sh" -t "$twinray" -o "$logs/history" "${scenes[@]}" -- \
    --width "$width" --no-embree --rounds 5 --build-qualities "$qualities" --max-seconds 2
if "$python" -c 'import twinray, trimesh' 2>"$logs/python"; then
    part peers 240 'wrong_per_million' "$python" "$here/peers/python_rays.py" --rays "$rays" \
        --subdivisions "$subdivisions" ${mesh:+--mesh "$mesh"} ${programs:+--programs "$programs"} \
        --seconds 200 -o "$folder/$device-peers.json" "${peers[@]}"
    grep 'left out' "$logs/peers"
else
    left_out peers "$python has not: $(tail -n 1 "$logs/python")"
fi

cat "$logs"/history/*.jsonl >>"$folder/$device.jsonl" 2>/dev/null
if [[ -s $logs/report.jsonl ]]; then cp "$logs/report.jsonl" "$folder/$device-report.jsonl"; fi

echo
"$twinray" devices | head -n 3
printf '%s\n' "${rows[@]}"
if [[ -s $folder/$device-peers.json ]]; then
    "$python" - "$folder/$device-peers.json" <<'PYTHON'
import json, sys
print("\nMrays/s, and how many of a million aimed rays are answered wrongly")
print(f"{'scene':24} {'package':12} {'build s':>8} {'camera':>9} {'random':>9} {'occlusion':>9}  wrong of 10^6")
for r in json.load(open(sys.argv[1])):
    rates = " ".join(f"{r[kind]['mrays_per_s']:9.2f}" for kind in ("camera", "random", "occlusion"))
    wrong = r.get("wrong_per_million", "-")
    print(f"{r['scene'][:24]:24} {r['package']:12} {r['build_seconds']:8.2f} {rates}  {wrong}")
PYTHON
fi
echo "logs: $logs"
