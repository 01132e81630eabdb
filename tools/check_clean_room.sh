#!/usr/bin/env bash
# Proves that the scripts work on a machine with nothing installed: puts a minimal Debian and this checkout into
# an empty folder, runs the scripts there in a chroot and prints their times. Needs root, debootstrap and 3 GB.
#   tools/check_clean_room.sh [--head] [--keep] FOLDER [COMMAND...]
#     --head     take the last commit instead of the working tree
#     --keep     leave FOLDER behind; without it, it is removed
#     COMMAND    "tools/demo.sh" and "tools/test.sh" unless given; quoted, run in turn
#     SUITE      the Debian release in the environment: bookworm unless it is set; trixie-backports is trixie with its
#                backports, and sid the newest
set -euo pipefail

suite=${SUITE-bookworm}
head=0
keep=0
while [[ ${1-} == --* ]]; do
    case $1 in
    --head) head=1 ;;
    --keep) keep=1 ;;
    *) set -- ;;
    esac
    shift $(($# > 0))
done
if (($# == 0)); then
    echo "usage: tools/check_clean_room.sh [--head] [--keep] FOLDER [COMMAND...]" >&2
    exit 2
fi
room=$(realpath -m "$1")
shift
commands=("$@")
if ((${#commands[@]} == 0)); then commands=(tools/demo.sh tools/test.sh); fi

if [[ -e $room && -n $(ls -A "$room") ]]; then
    echo "check_clean_room: $room is not empty" >&2
    exit 1
fi
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/lib.sh
can_make_rooms

# shellcheck disable=SC2317,SC2329
leave() {
    if ((!keep)); then rm -rf --one-file-system "$room"; fi
}
trap leave EXIT

section "Debian $suite into $room"
make_room "$room" "$suite"

section "Checkout"
if ((head)); then
    mkdir "$room/twinray"
    git archive HEAD | tar -x -C "$room/twinray"
else
    copy_checkout "$room/twinray"
fi

times=()
status=0
for command in "${commands[@]}"; do
    section "$command"
    start=$SECONDS
    result=passed
    in_room "$room" "cd /twinray && $command" || { result="FAILED ($?)" && status=1; }
    times+=("$(printf '%-40s %6d s  %s' "$command" $((SECONDS - start)) "$result")")
done

section "Clean room, Debian $suite"
printf '%s\n' "${times[@]}"
exit "$status"
