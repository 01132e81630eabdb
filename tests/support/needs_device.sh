#!/usr/bin/env bash
# Runs a command that needs a Vulkan device; without one it is skipped (status 77) unless TWINRAY_REQUIRE names vulkan.
#   needs_device.sh TWINRAY COMMAND [ARGUMENT...]
set -euo pipefail
twinray=$1
shift
if [[ ${TWINRAY_REQUIRE-} != *vulkan* ]] && ! "$twinray" devices > /dev/null; then exit 77; fi
exec "$@"
