# shellcheck shell=bash
# Functions that the scripts of this folder share; they change to the checkout, then source this file.

# A relative folder of assets is relative to the folder in which the user called the script.
if [[ -n ${TWINRAY_ASSETS-} ]]; then
    TWINRAY_ASSETS=$(cd "$OLDPWD" && realpath -m "$TWINRAY_ASSETS")
    export TWINRAY_ASSETS
fi

# Starts a section: its heading, and the time that the one before it took.
section() {
    section_end
    section_start=$SECONDS
    printf '\n== %s ==\n' "$*"
}

section_end() {
    if [[ -n ${section_start-} ]]; then printf -- '-- %d s\n' "$((SECONDS - section_start))"; fi
    section_start=
}

# Makes a Python with the packages that build and test twinray's package, at versions that are known to work. Prints its
# path, or on standard error why there is none.
python_for_package() {
    local folder=$PWD/build/venv
    local packages=(nanobind==3.1.0 nanobind-backend==1.0.0 numpy scipy pytest==9.2.0 trimesh==5.2.0)
    packages+=(tqdm matplotlib nbclient ipykernel) # of notebooks
    packages+=('dask[array,distributed]' xarray rioxarray zarr)
    if [[ "$(cat "$folder/complete" 2>/dev/null)" != "${packages[*]}" ]]; then
        python3 -m venv --clear "$folder" >&2 &&
            "$folder/bin/pip" install --quiet --disable-pip-version-check "${packages[@]}" >&2 || return
        echo "${packages[*]}" >"$folder/complete"
    fi
    echo "$folder/bin/python"
}

# Does the same for building the documentation and running the code of its pages.
python_for_docs() {
    local folder=$PWD/build/docs/venv wanted=docs/site/requirements.txt
    if ! cmp -s "$wanted" "$folder/installed.txt"; then
        python3 -m venv --clear "$folder" >&2 &&
            "$folder/bin/pip" install --quiet --disable-pip-version-check -r "$wanted" >&2 &&
            cp "$wanted" "$folder/installed.txt" || return
    fi
    echo "$folder/bin/python"
}

# Installs the packages and builds; the working directory is the checkout. TWINRAY_WERROR=ON in the environment makes
# warnings errors.
build() { # preset [what tools/setup.sh takes]
    section "Packages"
    tools/setup.sh "${@:2}"
    section "Configure ($1)"
    local options=() python
    if [[ -n ${TWINRAY_WERROR+set} ]]; then options+=(-DTWINRAY_WERROR="$TWINRAY_WERROR"); fi
    if [[ ${with_python-} ]]; then
        if python=$(python_for_package); then
            options+=(-DTWINRAY_PYTHON=ON -DPython_EXECUTABLE="$python")
        elif [[ ${TWINRAY_REQUIRE-} == *python* ]]; then
            return 1
        else
            echo "the Python package and its tests are left out: see above"
        fi
    fi
    cmake --preset "$1" "${options[@]}"
    section "Build ($1)"
    cmake --build --preset "$1"
}

# Rooms: folders with a minimal Debian of their own, in which scripts that run as root run commands by chroot. They need
# debootstrap.

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
