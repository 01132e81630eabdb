# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# What the scripts of this folder share; they change to the checkout, then source it.

# A relative folder of assets is meant from where the user called the script.
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

# Installs the packages and builds; the working directory is the checkout. TWINRAY_WERROR=ON in the environment makes
# warnings errors.
build() { # preset [what tools/setup.sh takes]
    section "Packages"
    tools/setup.sh "${@:2}"
    section "Configure ($1)"
    cmake --preset "$1" ${TWINRAY_WERROR+-DTWINRAY_WERROR="$TWINRAY_WERROR"}
    section "Build ($1)"
    cmake --build --preset "$1"
}
