#!/usr/bin/env bash
# Installs the Debian packages that twinray needs, and nothing else.
#   tools/setup.sh           install all; does nothing if everything is there
#   tools/setup.sh demo      install what path_tracer needs, and no more
#   tools/setup.sh python    install what `pip install .` needs, and no more
#   tools/setup.sh fuzz      install clang too, for tools/fuzz.sh
#   tools/setup.sh --undo    remove the apt configuration that it wrote
#   SKIP_APT=1               install nothing, whatever is missing
# On Debian 12 (bookworm) two things are not in the release itself: a Mesa whose CPU driver traces rays (from
# bookworm-backports) and the header-only Vulkan Memory Allocator (from trixie). Both suites are added at priorities
# that let through these packages and nothing else. On newer releases, and on Debian's children, such as
# Ubuntu, no configuration is written; it names what they do not serve.
set -euo pipefail

demo_packages=(
    g++ cmake ninja-build libvulkan-dev libvulkan-memory-allocator-dev libvulkan-volk-dev
    mesa-vulkan-drivers glslang-tools spirv-tools libglm-dev
    libtinygltf-dev libstb-dev nlohmann-json3-dev libcli11-dev libopenexr-dev zlib1g-dev
    libwebp-dev libavif-dev libmeshoptimizer-dev libdraco-dev
)
packages=(
    "${demo_packages[@]}" pkg-config python3-minimal python3-venv python3-dev vulkan-tools
    vulkan-validationlayers
    libgtest-dev libgmp-dev libeigen3-dev assimp-testmodels chromium-common graphviz gnuplot-nox
    doxygen
    libglfw3-dev libimgui-dev xvfb xauth mesa-drm-shim libopenmpi-dev openmpi-bin
)
if [[ $(uname -m) == x86_64 ]]; then packages+=(libembree-dev); fi # twinray bench also measures it
oldest_mesa=24 # the first whose lavapipe has acceleration structures and ray queries
# This is lost without a package that some release lacks; CMake names the others when it misses them.
declare -A without=(
    [libembree-dev]="twinray bench does not measure Embree" [chromium-common]="no tests on SwiftShader"
    [libglfw3-dev]="twinray view opens no window" [libimgui-dev]="twinray view opens no window"
    [assimp-testmodels]="tests of its models are skipped" [gnuplot-nox]="no plots" [doxygen]="no documentation"
    [libwebp-dev]="pictures in WebP are checkerboards" [libavif-dev]="pictures in AVIF are checkerboards"
    [libmeshoptimizer-dev]="glTF compressed by meshopt is refused" [libdraco-dev]="glTF compressed by Draco is refused"
    [libopenmpi-dev]="no ranks of MPI" [openmpi-bin]="no ranks of MPI"
    [graphviz]="no figures in the documentation" [vulkan-validationlayers]="nothing checks our use of Vulkan"
)

backports_file=/etc/apt/sources.list.d/twinray-bookworm-backports.sources
trixie_file=/etc/apt/sources.list.d/twinray-trixie-vma.sources
pin_file=/etc/apt/preferences.d/twinray.pref
keyring=/usr/share/keyrings/debian-archive-keyring.gpg

say() { printf 'setup: %s\n' "$*"; }
die() {
    printf 'setup: error: %s\n' "$*" >&2
    exit 1
}

# Prints the missing and outdated packages, one per line.
missing_packages() {
    local -A version=()
    local status package number
    while read -r status package number; do
        if [[ $status == installed ]]; then version[$package]=$number; fi
    done < <(dpkg-query -W -f '${db:Status-Status} ${Package} ${Version}\n' "${packages[@]}" 2>/dev/null)
    for package in "${packages[@]}"; do
        if [[ -z ${version[$package]-} ]]; then echo "$package"; fi
    done
    number=${version[mesa-vulkan-drivers]-}
    if [[ -n $number ]] && dpkg --compare-versions "$number" lt "$oldest_mesa"; then
        echo "mesa-vulkan-drivers >= $oldest_mesa (installed: $number)"
    fi
    if [[ -n $number && -n ${version[mesa-drm-shim]-} && ${version[mesa-drm-shim]} != "$number" ]] &&
        is_served "mesa-drm-shim=$number"; then
        echo "mesa-drm-shim=$number"
    fi
}

is_served() { apt-cache show "$1" >/dev/null 2>&1; } # package=version

# The shim works with a driver of its own version of Mesa alone, which backports may have brought.
match_shim_to_driver() {
    local number fitting i
    number=$(dpkg-query -W -f '${Version}' mesa-vulkan-drivers 2>/dev/null) || return 0
    fitting=mesa-drm-shim=$number
    for i in "${!packages[@]}"; do
        if [[ ${packages[i]} == mesa-drm-shim ]] && is_served "$fitting"; then packages[i]=$fitting; fi
    done
}

# Leaves out packages that apt does not serve, and names them.
leave_out_what_is_not_served() {
    local -A served=()
    local package wanted=("${packages[@]}")
    while read -r package; do
        served[$package]=1
    done < <(apt-cache show --no-all-versions "${wanted[@]}" 2>/dev/null | sed -n 's/^Package: //p')
    packages=()
    for package in "${wanted[@]}"; do
        if [[ ${served[$package]-} ]]; then packages+=("$package"); else
            say "apt serves no $package: ${without[$package]-CMake says whether it is needed}"
        fi
    done
}

# Prints the missing packages that apt's indexes serve.
left_to_install() {
    if ((!is_bookworm)) && [[ -n $(apt_sources) ]]; then leave_out_what_is_not_served >/dev/null; fi
    missing_packages
}

become_root() {
    if ((EUID == 0)); then
        as_root=()
    elif command -v sudo >/dev/null; then
        as_root=(sudo)
    else
        die "needs root: run it as root, or install sudo"
    fi
}

write_file() { # path, text from stdin
    say "writes $1"
    "${as_root[@]}" tee "$1" >/dev/null
    "${as_root[@]}" chmod 644 "$1"
}

# Runs apt-get with its output in the log.
apt_get() {
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -o Acquire::Retries=3 -o DPkg::Lock::Timeout=120 "$@" \
        >>"$log" 2>&1
}

say_how_to_undo() {
    if [[ -e $pin_file ]]; then say "to remove the apt configuration again: tools/setup.sh --undo"; fi
}

apt_failed() { # what failed
    printf 'setup: %s failed; the end of %s:\n' "$1" "$log" >&2
    tail -n 15 "$log" | sed 's/^/    /' >&2
    if grep -qE 'bookworm-backports.* does (not|no longer) have a Release file' "$log"; then
        say "bookworm-backports was not found on the mirror. Debian moves old suites to its archive mirror: put that" \
            "mirror's address into $backports_file and run this script again." >&2
    fi
    if grep -q NO_PUBKEY "$log"; then
        say "a signing key is missing: upgrade the package debian-archive-keyring and run this script again." >&2
    fi
    say_how_to_undo >&2
    exit 1
}

# Prints one line per index that apt reads: origin, codename, component, file that names it, mirror.
# shellcheck disable=SC2016
apt_sources() {
    local format='$(ORIGIN)|$(CODENAME)|$(COMPONENT)|$(SOURCESENTRY)|$(REPO_URI)'
    apt-get indextargets --format "$format" 'Created-By: Packages'
}

# Prints the mirror that already serves this system's Debian packages.
debian_mirror() {
    apt_sources | awk -F'|' '!uri && $1 == "Debian" && $2 == "bookworm" && $3 == "main" && $5 !~ /^cdrom:/ {
                                 uri = $5 }
                             END { print uri }'
}

# Tells whether a file that twinray did not write offers the suite; a second entry could then contradict it.
is_configured() {
    apt_sources | awk -F'|' -v suite="$1" '$2 == suite && $3 == "main" && $4 !~ /\/twinray-/ { found = 1 }
                                           END { exit !found }'
}

write_source() { # path, suite, mirror
    if [[ -e $1 ]]; then return; fi # someone may have put another mirror there
    printf 'Types: deb\nURIs: %s\nSuites: %s\nComponents: main\nSigned-By: %s\n' "$3" "$2" "$keyring" |
        write_file "$1"
}

configure_bookworm() {
    local mirror
    mirror=$(debian_mirror)
    if [[ -z $mirror ]]; then # apt has never read its indexes
        say "reads the package indexes"
        apt_get update || true
        mirror=$(debian_mirror)
    fi
    if [[ -z $mirror ]]; then
        die "apt has no working source for bookworm main (see $log)"
    fi
    if [[ ! -e $keyring ]]; then
        die "$keyring is missing: install debian-archive-keyring"
    fi

    local pins=$'Package: libvulkan-memory-allocator-dev\nPin: release n=trixie\nPin-Priority: 500\n\n'
    pins+=$'Package: src:mesa src:libdrm\nPin: release n=bookworm-backports\nPin-Priority: 500\n'
    if ! is_configured trixie; then # else trixie keeps the priority that someone chose for it
        write_source "$trixie_file" trixie "$mirror"
        pins=$'Package: *\nPin: release n=trixie\nPin-Priority: -10\n\n'$pins
    fi
    if ! is_configured bookworm-backports; then write_source "$backports_file" bookworm-backports "$mirror"; fi
    write_file "$pin_file" <<<"${pins%$'\n'}"
}

install_packages() {
    become_root
    log=$(mktemp --suffix=.log "${TMPDIR:-/tmp}/twinray-setup.XXXXXX")
    if ((is_bookworm)); then configure_bookworm; fi
    # An unrelated source of this system may fail without harm; twinray's may not.
    if ! apt_get update && grep -qE '^(E|Err).*(bookworm-backports|trixie)' "$log"; then
        apt_failed "reading the package indexes"
    fi
    if ((!is_bookworm)); then leave_out_what_is_not_served; fi
    local wanted=("${packages[@]}")
    match_shim_to_driver
    say "installs ${#packages[@]} packages and what they depend on; log in $log"
    apt_get install -y --no-install-recommends "${packages[@]}" || apt_failed "installing"
    packages=("${wanted[@]}")
    { grep -h '^Need to get' "$log" || true; } | sed 's/^Need to get/setup: downloaded/'
    local missing
    missing=$(missing_packages)
    if [[ -n $missing ]] && ((!is_bookworm)); then
        say "too old to trace rays on the CPU; the driver of a GPU does: $missing"
    elif [[ -n $missing ]]; then
        die "apt reported no error, but these are missing or too old (log in $log): ${missing//$'\n'/, }"
    fi
    say_how_to_undo
    say "done in $SECONDS s"
}

undo() {
    local file removed=0
    for file in "$backports_file" "$trixie_file" "$pin_file"; do
        if [[ -e $file ]]; then
            become_root
            "${as_root[@]}" rm -f "$file"
            say "removed $file"
            removed=1
        fi
    done
    if ((removed)); then
        say "the packages stay installed (/var/log/apt/history.log lists them); run 'apt-get update' when convenient"
    else
        say "nothing to undo"
    fi
}

main() {
    case ${1-} in
    --undo)
        undo
        return
        ;;
    demo) packages=("${demo_packages[@]}") ;;
    fuzz) packages+=(clang-19 libclang-rt-19-dev llvm-19) ;;
    python) packages=("${demo_packages[@]}" libeigen3-dev python3-dev python3-venv) ;;
    '') ;;
    *) die "unknown option '$1'; usage: tools/setup.sh [demo|python|fuzz|--undo]" ;;
    esac
    if [[ ${SKIP_APT-} == 1 ]]; then
        say "SKIP_APT=1, installs nothing"
        return
    fi
    local ID='' ID_LIKE='' VERSION_CODENAME='' is_bookworm=0
    # shellcheck disable=SC1091
    if [[ -r /etc/os-release ]]; then . /etc/os-release; fi
    if [[ "$ID $VERSION_CODENAME" == 'debian bookworm' ]]; then is_bookworm=1; fi
    if [[ " $ID $ID_LIKE " != *' debian '* ]]; then
        say "this is neither Debian nor a child of it: nothing is installed. twinray needs, by their Debian names:"
        printf '    %s\n' "${packages[*]}" | fold -s -w 110
        say "with Mesa >= $oldest_mesa, or the driver of a GPU. CMake names what it does not find."
        return
    fi
    if [[ -z $(left_to_install) ]]; then
        say "all packages that apt serves are installed"
        return
    fi
    install_packages
}

main "$@"
