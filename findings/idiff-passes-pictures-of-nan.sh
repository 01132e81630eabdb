#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: OpenImageIO's idiff, which many renderers' tests take to compare pictures, fails where a pixel of one
# picture is NaN and the same pixel of the other is 0.5, as it does for infinity.
# Seen: idiff and oiiotool --diff say PASS and exit with 0 for one NaN pixel, and for a picture that is NaN throughout,
# in either order, and with "-fail 0 -failpercent 0" too. Infinity, or 0.501 for 0.5, fails. Beside a pixel that fails,
# NaNs are not counted. ImageBufAlgo.compare() of Python has a mean error of nan there, but nfail 0 and error False; one
# NaN pixel has a maxerror of 0. "oiiotool --stats" counts them (NanCount).
# Seen with OpenImageIO 3.2.2.0 from PyPI on 2026-11-30. Needs Python 3.12 or 3.13, 300 MB and no root.
folder=$(mktemp -d)
# shellcheck source=findings/checks.sh
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
make_venv venv OpenImageIO==3.2.2.0 numpy==2.4.6

cat >pictures.py <<'END'
import sys

import numpy as np
import OpenImageIO as oiio

print("OpenImageIO", oiio.__version__, file=sys.stderr)
grey = np.full((32, 32, 3), 0.5, np.float32)
pictures = {name: grey.copy() for name in ("grey", "one", "all", "infinite", "other", "both")}
pictures["one"][3, 3] = np.nan
pictures["all"][:] = np.nan
pictures["infinite"][3, 3] = np.inf
pictures["other"][3, 3] = 0.501
pictures["both"][:16] = np.nan
pictures["both"][20, 3] = 0.501
for name, pixels in pictures.items():
    file = oiio.ImageOutput.create("picture.exr")
    file.open(f"{name}.exr", oiio.ImageSpec(32, 32, 3, "float"))
    file.write_image(pixels)
    file.close()
for name in pictures:
    found = oiio.ImageBufAlgo.compare(oiio.ImageBuf("grey.exr"), oiio.ImageBuf(f"{name}.exr"), 1e-6, 1e-6)
    print(f"{name} {found.error}/{found.nfail}/{found.meanerror:.3g}/{found.maxerror:.3g}")
END
venv/bin/python pictures.py >results
result() { # a command that compares: its last word and its exit status
    local log status=0
    log=$("venv/bin/$1" "${@:2}" 2>&1) || status=$?
    echo "$(grep -oE 'PASS|FAILURE' <<<"$log" | tail -n 1) $status"
}
for name in one all; do
    same "idiff grey.exr $name.exr" "$(result idiff grey.exr "$name.exr")" "PASS 0"
    same "idiff $name.exr grey.exr" "$(result idiff "$name.exr" grey.exr)" "PASS 0"
    same "idiff -fail 0 -failpercent 0 grey.exr $name.exr" \
        "$(result idiff -fail 0 -failpercent 0 grey.exr "$name.exr")" "PASS 0"
    same "oiiotool --diff grey.exr $name.exr" "$(result oiiotool --diff grey.exr "$name.exr")" "PASS 0"
done
for name in infinite other both; do
    same "idiff grey.exr $name.exr" "$(result idiff grey.exr "$name.exr")" "FAILURE 2"
done
compare() { grep "^$1 " results | cut -d' ' -f2; }
same "compare(), error/nfail/meanerror/maxerror, one NaN" "$(compare one)" False/0/nan/0
same "compare(), all NaN" "$(compare all)" False/0/nan/nan
same "compare(), infinity" "$(compare infinite)" True/1/inf/inf
same "compare(), 512 NaN pixels and one of 0.501" "$(compare both)" True/1/nan/0.001
same "NaNs that oiiotool --stats counts in the red of all.exr" \
    "$(venv/bin/oiiotool --stats all.exr | sed -n 's/.*Stats NanCount: \([0-9]*\) .*/\1/p')" 1024
conclude
