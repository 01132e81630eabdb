#!/usr/bin/env python3
"""`twinray kernels` for a GPU that is not there. Usage: kernels_command_test.py TWINRAY"""
import json
import os
import subprocess
import sys
import tempfile
import unittest

TWINRAY = sys.argv.pop(1)
HEAD = "kernel specialisation VGPR waves scratch shared spills instructions".split()


def kernels(*arguments, **environment):
    return subprocess.run([TWINRAY, "kernels", *arguments], capture_output=True, text=True, check=False,
                          env={**os.environ, **environment})


class KernelsCommand(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = os.path.join(folder.name, "rows.json")

    def rows(self):
        with open(self.file, encoding="utf-8") as lines:
            return [json.loads(line) for line in lines]

    def write(self, rows):
        with open(self.file, "w", encoding="utf-8") as out:
            out.writelines(json.dumps(row) + "\n" for row in rows)

    def test_a_table_for_each_family_and_the_same_rows_as_json(self):
        result = kernels("--family", "navi21,navi31", "--filter", "sort_", "--json", self.file)
        self.assertEqual(result.returncode, 0, result.stderr)
        lines = [line.split() for line in result.stdout.splitlines()]
        self.assertEqual(lines.count(HEAD), 2)
        rows = self.rows()
        self.assertEqual([row["device"] for row in rows if "driver" in row], ["navi21", "navi31"])
        scans = [row for row in rows if row.get("kernel") == "sort_scan"]
        self.assertEqual(len(scans), 2)
        for scan in scans:
            self.assertGreater(scan["vgprs"], 0)
            self.assertEqual(scan["scratch"], 0)
            self.assertIn(scan["subgroup"], (32, 64))
            self.assertTrue(any(line[:1] == ["sort_scan"] and line[-1] == str(scan["instructions"]) for line in lines))

    def test_what_builds_record(self):
        result = kernels("--family", "navi21", "--json", self.file)
        self.assertEqual(result.returncode, 0, result.stderr)
        builds = {row["build"]: row for row in self.rows() if "build" in row}
        refits = {row["refit"]: row for row in self.rows() if "refit" in row}
        self.assertEqual(len(builds), 9)
        for name, refit in refits.items():
            build = builds[name]
            self.assertGreater(build["dispatches"], refit["dispatches"])
            self.assertGreater(build["barriers"], build["dispatches"] / 2)
            self.assertGreater(refit["dispatches"], 0)
            self.assertGreater(build["read_bytes_per_triangle"], refit["read_bytes_per_triangle"])
        self.assertIn("compressed8  ploc", result.stdout)

    def test_what_grew_and_what_is_new_is_told(self):
        kernels("--family", "navi21", "--filter", "sort_", "--json", self.file)
        same = kernels("--family", "navi21", "--filter", "sort_", "--against", self.file)
        self.assertEqual(same.returncode, 0, same.stdout)
        rows = [row for row in self.rows() if row.get("kernel") != "sort_histogram"]
        for row in rows:
            if row.get("kernel") == "sort_scan":
                row["vgprs"] -= 1
        self.write(rows)
        worse = kernels("--family", "navi21", "--filter", "sort_", "--against", self.file)
        self.assertEqual(worse.returncode, 1)
        self.assertIn("navi21: sort_scan: ", worse.stdout)
        self.assertIn("navi21: sort_histogram: no limit is recorded", worse.stdout)
        self.assertIn("2 past the limits", worse.stdout)

    def test_hardware_kernels_need_ray_queries(self):
        self.assertIn("hwtlas_trace", kernels("--family", "navi21", "--filter", "hwtlas_trace any").stdout)
        without = kernels("--family", "navi21", "--filter", "hwtlas_trace any", TWINRAY_DISABLE="ray_query")
        self.assertEqual(without.returncode, 1)
        self.assertIn("no kernel has 'hwtlas_trace any'", without.stderr)

    def test_a_family_that_is_none(self):
        result = kernels("--family", "navi99")
        self.assertEqual(result.returncode, 2)
        self.assertIn("navi99", result.stderr)
        self.assertIn("ampere", result.stderr)

    def test_a_gpu_that_the_shim_does_not_know(self):
        """The program is made to believe that it runs over a shim, which is not there."""
        result = kernels("--family", "ada", NOUVEAU_CHIPSET="192", LD_PRELOAD="libnouveau_noop_drm_shim.so",
                         VK_DRIVER_FILES="/nowhere.json", VK_ICD_FILENAMES="/nowhere.json")
        self.assertEqual(result.returncode, 1)
        self.assertIn("twinray: family 'ada' is not available: this Mesa's libnouveau_noop_drm_shim.so", result.stderr)
        self.assertIn("does not know NVIDIA Ada (NOUVEAU_CHIPSET=192)", result.stderr)

    def test_other_families_are_compiled_where_one_is_not_here(self):
        result = kernels("--family", "ada,navi21", "--filter", "sort_scan")
        self.assertEqual(result.returncode, int("family 'ada' is not available" in result.stderr), result.stderr)
        self.assertIn("navi21: ", result.stdout)

    def test_limits_of_another_release_are_not_compared(self):
        kernels("--family", "navi21", "--filter", "sort_scan", "--json", self.file)
        rows = self.rows()
        rows[0]["driver"] = "radv Mesa 1.0"
        self.write(rows)
        result = kernels("--family", "navi21", "--filter", "sort_scan", "--against", self.file)
        self.assertEqual(result.returncode, 1)
        self.assertIn("navi21: not compared: the driver is radv Mesa ", result.stdout)

    def test_a_device_and_a_family_exclude_each_other(self):
        self.assertEqual(kernels("--family", "navi21", "--device", "0").returncode, 2)

    def test_limits_that_cannot_be_read(self):
        result = kernels("--family", "navi21", "--filter", "sort_scan", "--against", self.file)
        self.assertEqual(result.returncode, 1)
        self.assertIn("cannot be read", result.stderr)


if __name__ == "__main__":
    unittest.main()
