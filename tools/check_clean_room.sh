#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Proves that the scripts work on a machine with nothing installed: puts a minimal Debian 12 and this checkout into
# an empty folder, runs the scripts there in a chroot and prints their times. Needs root, debootstrap and 3 GB.
#   tools/check_clean_room.sh [--head] [--keep] FOLDER [COMMAND...]
#     --head     take the last commit instead of the working tree
#     --keep     leave FOLDER behind; without it, it is removed
#     COMMAND    "tools/demo.sh" and "tools/test.sh" unless given; quoted, run in turn
#     SUITE      the Debian release in the environment: bookworm unless it is set
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

if ((EUID != 0)); then
    echo "check_clean_room: needs root" >&2
    exit 1
fi
if [[ -e $room && -n $(ls -A "$room") ]]; then
    echo "check_clean_room: $room is not empty" >&2
    exit 1
fi
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/lib.sh

# shellcheck disable=SC2317,SC2329
leave() {
    if mountpoint -q "$room/proc"; then umount "$room/proc"; fi
    if ((!keep)); then rm -rf --one-file-system "$room"; fi
}
trap leave EXIT

section "Debian $suite into $room"
# shellcheck disable=SC2016
mirror=$(apt-get indextargets --format '$(ORIGIN)|$(COMPONENT)|$(LABEL)|$(REPO_URI)' 'Created-By: Packages' |
    awk -F'|' '!uri && $1 == "Debian" && $2 == "main" && $3 == "Debian" { uri = $4 } END { print uri }')
if [[ -z $mirror ]]; then
    echo "check_clean_room: apt has no Debian mirror; run apt-get update" >&2
    exit 1
fi
include=()
if [[ $mirror == https:* ]]; then include=(--include=ca-certificates); fi
mkdir -p "$room"
debootstrap --variant=minbase "${include[@]}" "$suite" "$room" "$mirror" >"$room.log" 2>&1 || {
    tail -n 15 "$room.log" >&2
    exit 1
}
rm -f "$room.log"

# The network as this machine sees it: names (localhost is one), name servers, apt's proxies and other transport
# settings.
cp -L /etc/resolv.conf "$room/etc/resolv.conf"
cp -L /etc/hosts "$room/etc/hosts"
apt-config dump | grep -E '^Acquire::(https?::.*|Check-[A-Za-z-]*|Retries) "' \
    >"$room/etc/apt/apt.conf.d/99transport" || true
proxies=()
for name in http_proxy https_proxy no_proxy; do
    if [[ -n ${!name-} ]]; then proxies+=("$name=${!name}"); fi
done
if [[ -r ${PIP_CERT-} ]]; then # whom pip trusts
    cp -L "$PIP_CERT" "$room/etc/pip-certificates.crt"
    proxies+=(PIP_CERT=/etc/pip-certificates.crt)
fi

section "Checkout"
mkdir "$room/twinray"
if ((head)); then
    git archive HEAD | tar -x -C "$room/twinray"
else
    tar -c --exclude=./.git --exclude='./build*' --exclude=./out . | tar -x -C "$room/twinray" --no-same-owner
fi
mount -t proc proc "$room/proc"

times=()
status=0
for command in "${commands[@]}"; do
    section "$command"
    start=$SECONDS
    result=passed
    env -i "${proxies[@]}" PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
        chroot "$room" bash -c "cd /twinray && $command" || { result="FAILED ($?)" && status=1; }
    times+=("$(printf '%-40s %6d s  %s' "$command" $((SECONDS - start)) "$result")")
done

section "Clean room, Debian $suite"
printf '%s\n' "${times[@]}"
exit "$status"
