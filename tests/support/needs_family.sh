#!/usr/bin/env bash
# Runs a command that compiles for an absent GPU. It is skipped (status 77) if this machine's Mesa cannot do so, or is
# another release than the one with the recorded limits; but if TWINRAY_REQUIRE names vulkan, RADV has to be there.
#   needs_family.sh FAMILY COMMAND [ARGUMENT...]
set -euo pipefail
family=$1
shift
said=$(mktemp)
trap 'rm -f "$said"' EXIT
status=0
"$@" > "$said" 2>&1 || status=$?
cat "$said"
if ((status == 0)); then exit 0; fi
if grep -q "^$family: not compared" "$said"; then exit 77; fi
if grep -q "family '$family' is not available" "$said" && [[ ${TWINRAY_REQUIRE-} != *vulkan* || $family != navi* ]]; then
    exit 77
fi
exit "$status"
