# SPDX-License-Identifier: MIT
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
