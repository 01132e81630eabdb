#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs a command that needs Mesa's RADV, though none of its hardware; without it the command is skipped (status 77) unless
# TWINRAY_REQUIRE names vulkan.
#   needs_radv.sh COMMAND [ARGUMENT...]
set -euo pipefail
if [[ ${TWINRAY_REQUIRE-} != *vulkan* ]] && ! compgen -G '/*/vulkan/icd.d/radeon_icd*.json' > /dev/null &&
    ! compgen -G '/usr/*/vulkan/icd.d/radeon_icd*.json' > /dev/null &&
    ! compgen -G '/usr/local/*/vulkan/icd.d/radeon_icd*.json' > /dev/null; then
    exit 77
fi
exec "$@"
