"""What is left of a SPIR-V module when its specialisation constants are known."""
import pathlib
import struct
import subprocess
import tempfile

folder = pathlib.Path(tempfile.mkdtemp())


def count(module, constants):
    """Instructions between OpFunction and OpFunctionEnd, without labels and line numbers, of the module frozen with the
    constants (by id) and optimised by spirv-opt."""
    frozen = folder / "frozen.spv"
    values = " ".join(f"{number}:{value}" for number, value in constants.items())
    subprocess.run(["spirv-opt", "--scalar-block-layout", "--target-env=vulkan1.2", f"--set-spec-const-default-value={values}",
                    "--freeze-spec-const", "--fold-spec-const-op-composite", "-O", module, "-o", str(frozen)], check=True)
    data = frozen.read_bytes()
    words, at, inside, found = struct.unpack(f"<{len(data) // 4}I", data), 5, False, 0
    while at < len(words):
        opcode = words[at] & 0xFFFF
        inside = (inside or opcode == 54) and opcode != 56
        found += inside and opcode not in (8, 248, 317)
        at += words[at] >> 16
    return found
