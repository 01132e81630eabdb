#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Verifies triangles that share nothing on the driver as it is and as each fault of broken_driver.c makes it.
Usage: broken_driver_test.py TWINRAY FOLDER_OF_THE_LAYER"""

import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile

twinray, layer, here = sys.argv[1], sys.argv[2], pathlib.Path(tempfile.mkdtemp())
SHOWS = {
    "cull": "HW_LEAK",
    "first": "HW_LEAK",
    "distance": "HW_T_ERR",
    "infinite": "HW_RANGE",
    "triangle": "HW_FALSE",
}
RAYS = 5000


def counts(fault):
    """Of each accelerator, on a driver with this fault; "" for the driver as it is."""
    environment = dict(os.environ, TWINRAY_BROKEN_DRIVER=fault)
    if fault:
        environment.update(VK_ADD_LAYER_PATH=layer, VK_INSTANCE_LAYERS="VK_LAYER_TWINRAY_broken_driver")
    records = here / f"{fault}.jsonl"
    command = [twinray, "verify", here / "soup.obj", "--random", str(RAYS), "--aimed", "0", "--json", records,
               "--quiet"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True, cwd=here)
    assert done.returncode == 0, f"{fault}: status {done.returncode}\n{done.stdout}{done.stderr}"
    return {
        record["backend"]: record["counts"]
        for record in map(json.loads, records.read_text().splitlines())
        if record["case"] == "verify.random"
    }


# Triangles in all directions, many behind another.
random.seed(1)
with open(here / "soup.obj", "w") as soup:
    for _ in range(400):
        center = [random.uniform(-1, 1) for _ in range(3)]
        for _ in range(3):
            print("v", *(f"{x + random.uniform(-0.3, 0.3):.9g}" for x in center), file=soup)
        print("f -3 -2 -1", file=soup)

as_it_is = counts("")
if "hw" not in as_it_is:
    print("the device has no hardware path that could be broken")
    sys.exit(77)
if any(as_it_is["hw"][kind] for kind in SHOWS.values()):
    print(f"the driver is wrong as it is: {as_it_is['hw']}")
    sys.exit(77)
for fault, kind in SHOWS.items():
    broken = counts(fault)
    assert 0 < broken["hw"][kind] < RAYS / 2, f"{fault}: {broken['hw']}"
    assert broken["sw"] == as_it_is["sw"], f"{fault} reached SwTlas: {broken['sw']}"
    print(f"broken_driver: {fault}: {broken['hw'][kind]} of {RAYS} rays are {kind}")
