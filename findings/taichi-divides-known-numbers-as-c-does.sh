#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: Taichi's documentation of operators says that % is Python's, not C's, and // is floored. So -1 % 8 is 7
# in a kernel, as in Python, and a loop that ti.static unrolls computes what the plain loop computes.
# Seen: that holds for what the kernel learns at run time. If the compiler knows both numbers, it divides as C does. For
# a = -5 and b = 3, two variables of a kernel, a % b is -2 and a // b is -1; as arguments of the kernel they give 1 and
# -2. A ti.func that returns i % n gives -1 for (-1, 8), and 7 if 8 is an argument. With k = i - 1, k % 3 over range(3)
# is 2 0 1, and over ti.static(range(3)) it is -1 0 1. The literals -5 % 3 give 1, and variables of floats are floored.
# Seen with taichi 1.7.4, and quadrants 1.3.3, a fork of it, on 2026-11-30. Needs Python 3.12 or 3.13,
# 800 MB and no root.
folder=$(mktemp -d)
# shellcheck source=findings/checks.sh
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
make_venv venv taichi==1.7.4 quadrants==1.3.3 numpy==2.5.5 \
    colorama==0.4.6 dill==0.4.1 rich==15.0.0 pydantic==2.14.4 cffi==2.1.1 setuptools==84.2.1

cat >remainders.py <<'END'
import importlib
import sys

ti = importlib.import_module(sys.argv[1])

ti.init(arch=ti.cpu, log_level=ti.ERROR, offline_cache=False)
triple = ti.types.vector(3, ti.i32)


@ti.kernel
def of_variables() -> ti.types.vector(2, ti.i32):
    a = -5
    b = 3
    return ti.Vector([a % b, a // b])


@ti.kernel
def of_arguments(a: ti.i32, b: ti.i32) -> ti.types.vector(2, ti.i32):
    return ti.Vector([a % b, a // b])


@ti.kernel
def of_literals() -> ti.types.vector(2, ti.i32):
    return ti.Vector([-5 % 3, -5 // 3])


@ti.func
def wrapped(i, n):
    return i % n


@ti.kernel
def wrapped_at_a_known_size() -> ti.i32:
    return wrapped(-1, 8)


@ti.kernel
def wrapped_at_a_given_size(n: ti.i32) -> ti.i32:
    return wrapped(-1, n)


@ti.kernel
def plain_loop() -> triple:
    found = triple(0)
    for i in range(3):
        k = i - 1
        found[i] = k % 3
    return found


@ti.kernel
def unrolled_loop() -> triple:
    found = triple(0)
    for i in ti.static(range(3)):
        k = i - 1
        found[i] = k % 3
    return found


@ti.kernel
def of_floats() -> ti.types.vector(2, ti.f32):
    a = -5.5
    b = 3.0
    return ti.Vector([a % b, a // b])


print("version", *ti.__version__)
print("variables", *of_variables().to_numpy())
print("arguments", *of_arguments(-5, 3).to_numpy())
print("literals", *of_literals().to_numpy())
print("Python", -5 % 3, -5 // 3)
print("known", wrapped_at_a_known_size())
print("given", wrapped_at_a_given_size(8))
print("plain", *plain_loop().to_numpy())
print("unrolled", *unrolled_loop().to_numpy())
print("floats", *of_floats().to_numpy())
END
row() { grep "^$1 " results | cut -d' ' -f2-; }
for library in taichi quadrants; do
    venv/bin/python remainders.py "$library" >results
    if [[ $library == taichi ]]; then version="1 7 4"; else version="1 3 3"; fi
    same "version of $library" "$(row version)" "$version"
    same "a % b and a // b of two variables of the kernel, -5 and 3" "$(row variables)" "-2 -1"
    same "a % b and a // b of its arguments, -5 and 3" "$(row arguments)" "1 -2"
    same "-5 % 3 and -5 // 3" "$(row literals)" "1 -2"
    same "-5 % 3 and -5 // 3 in Python" "$(row Python)" "1 -2"
    same "wrapped(-1, 8)" "$(row known)" -1
    same "wrapped(-1, n) with the argument n = 8" "$(row given)" 7
    same "k % 3 with k = i - 1, over range(3)" "$(row plain)" "2 0 1"
    same "k % 3 with k = i - 1, over ti.static(range(3))" "$(row unrolled)" "-1 0 1"
    same "a % b and a // b of two float variables, -5.5 and 3" "$(row floats)" "0.5 -2.0"
done
conclude
