#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs the commands of one part of docs/gallery.md, in a folder of their own, and takes out its pictures.
# Usage: make_picture.sh PROGRAMS NAME FOLDER PICTURE...   PROGRAMS: the folder of path_tracer, twinray and the samples;
#                                                          NAME: as in the fence of the commands, gallery_NAME;
#                                                          FOLDER: where its pictures go
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
programs=$(cd "$1" && pwd) name=$2 pictures=$3
mkdir -p "$pictures"
pictures=$(cd "$pictures" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

cd "$work"
sed -n "/^\`\`\`sh .*gallery_$name /,/^\`\`\`$/ { /^\`\`\`/!p }" "$here/../../docs/gallery.md" >commands.sh
PATH=$programs:$here:$PATH PYTHONDONTWRITEBYTECODE=1 bash -euo pipefail commands.sh
mv "${@:4}" "$pictures"
