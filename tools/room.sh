# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# Rooms: folders with a minimal Debian of their own, in which scripts run commands by chroot. Scripts that run as root
# source it; it needs debootstrap.

# Fails with the reason if rooms cannot be made here.
can_make_rooms() {
    if ((EUID != 0)); then
        echo "rooms need root" >&2
        return 1
    fi
    if ! command -v debootstrap >/dev/null; then
        echo "rooms need debootstrap (apt-get install debootstrap)" >&2
        return 1
    fi
    # Only programs in a room see its mounts.
    if ! unshare --mount true 2>/dev/null; then
        echo "rooms need mounts, which this container does not allow" >&2
        return 1
    fi
}

# Makes a room: bookworm, or trixie-backports for trixie with its backports, or sid.
make_room() { # folder, suite
    local room=$1 suite=${2%-backports} mirror script include=()
    # shellcheck disable=SC2016
    mirror=$(apt-get indextargets --format '$(ORIGIN)|$(COMPONENT)|$(LABEL)|$(REPO_URI)' 'Created-By: Packages' |
        awk -F'|' '!uri && $1 == "Debian" && $2 == "main" && $3 == "Debian" { uri = $4 } END { print uri }')
    if [[ -z $mirror ]]; then
        echo "apt has no Debian mirror; run apt-get update" >&2
        return 1
    fi
    if [[ $mirror == https:* ]]; then include=(--include=ca-certificates); fi
    script=/usr/share/debootstrap/scripts/$suite
    if [[ ! -e $script ]]; then script=/usr/share/debootstrap/scripts/sid; fi # newer than debootstrap
    mkdir -p "$room"
    debootstrap --variant=minbase "${include[@]}" "$suite" "$room" "$mirror" "$script" >"$room.log" 2>&1 || {
        tail -n 15 "$room.log" >&2
        return 1
    }
    rm -f "$room.log"
    if [[ $2 == *-backports ]]; then echo "deb $mirror $2 main" >>"$room/etc/apt/sources.list"; fi

    # The network as this machine sees it: names (localhost is one), name servers, apt's proxies and other transport
    # settings, and pip's trusted certificates.
    cp -L /etc/resolv.conf /etc/hosts "$room/etc"
    apt-config dump | grep -E '^Acquire::(https?::.*|Check-[A-Za-z-]*|Retries) "' \
        >"$room/etc/apt/apt.conf.d/99transport" || true
    if [[ -r ${PIP_CERT-} ]]; then cp -L "$PIP_CERT" "$room/etc/pip-certificates.crt"; fi
}

# Runs a line of bash in a room, with nothing of this machine but the network and the folders named.
in_room() { # room, line [folder that has the same path there]...
    local settings=() name
    for name in http_proxy https_proxy no_proxy; do
        if [[ -n ${!name-} ]]; then settings+=("$name=${!name}"); fi
    done
    if [[ -e $1/etc/pip-certificates.crt ]]; then settings+=(PIP_CERT=/etc/pip-certificates.crt); fi
    # The line ends by exit, so that its shell says which command a signal ended.
    # shellcheck disable=SC2016
    env -i "${settings[@]}" PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
        unshare --mount bash -ec '
            mount -t proc proc "$1/proc"
            for folder in "${@:3}"; do
                mkdir -p "$1$folder"
                mount --bind "$folder" "$1$folder"
            done
            exec chroot "$1" bash -c "$2"' in_room "$1" "$2"$'\nexit' "${@:3}"
}

# Installs packages in a room, with their output in a log beside it.
install_in_room() { # room, what apt-get install takes
    local log=$1.apt.log
    in_room "$1" "apt-get update && apt-get install -y --no-install-recommends ${*:2}" >"$log" 2>&1 || {
        tail -n 15 "$log" >&2
        return 1
    }
    rm "$log"
}

# Copies the working tree, except files that git ignores, into a folder, whose builds stay.
copy_checkout() { # folder
    mkdir -p "$1"
    find "$1" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
    git ls-files -z --cached --others --exclude-standard --deduplicate |
        tar -c --null --files-from=- --ignore-failed-read | tar -x -C "$1" --no-same-owner
}
