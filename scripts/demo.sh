#!/usr/bin/env bash
# Sets the machine up, builds, renders the demo sequence and says where the pictures are.
# Frames that are already there and belong to the same scene are kept.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/setup.sh
scripts/build.sh release mote mote_oiio

mote=build/release/src/app/mote
out=out/demo
"$mote" render scenes/demo.toml --existing verify \
    --output "$out/exr/demo.####.exr" --preview "$out/png/demo.####.png"
"$mote" sheet "$out/contact_sheet.png" "$out"/png/demo.*.png --columns 6

cat <<TXT

The demo sequence is done:
  frames         $PWD/$out/exr/   (OpenEXR, linear, with layers: try  $mote info $out/exr/demo.0001.exr)
  previews       $PWD/$out/png/
  contact sheet  $PWD/$out/contact_sheet.png
TXT
