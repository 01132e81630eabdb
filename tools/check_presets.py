#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Checks presets that share a folder: one may find options on in the cache that another has set.

Usage: check_presets.py; prints each option that a preset leaves as it was while it sets what the option needs to OFF
(cmake/options.cmake), and exits with 1: CMake would refuse to configure.
"""

import json
import pathlib
import re
import sys

root = pathlib.Path(__file__).resolve().parent.parent
needs = re.findall(r"^twinray_option_needs\((\w+) ([\w ]+)\)", (root / "cmake/options.cmake").read_text(), re.M)
listed = json.loads((root / "CMakePresets.json").read_text())["configurePresets"]
presets = {preset["name"]: preset for preset in listed}


def variables(name):
    preset = presets[name]
    inherited = variables(preset["inherits"]) if "inherits" in preset else {}
    return inherited | preset.get("cacheVariables", {})


found = []
for name in presets:
    values = variables(name)
    off = {option for option, value in values.items() if value == "OFF"}
    found += [
        f"preset {name}: {option} may be on from before, and needs {needed}"
        for option, all_needed in needs
        for needed in all_needed.split()
        if needed in off and option not in off
    ]
print("\n".join(found) or f"check_presets: {len(presets)} presets set all to OFF that needs what they set to OFF")
sys.exit(bool(found))
