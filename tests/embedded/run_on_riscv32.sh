#!/usr/bin/env bash
# Compiles the landmark core and its test vectors for a bare 32-bit RISC-V without floating point and runs them
# in QEMU. Usage: run_on_riscv32.sh SOURCE_DIR WORK_DIR. Ends with 77 where a tool is missing.
set -euo pipefail
source=$1 work=$2
for tool in riscv64-unknown-elf-g++ qemu-system-riscv32; do
  command -v $tool >/dev/null || { echo "skipped: $tool is not installed (gcc-riscv64-unknown-elf, qemu-system-misc)"; exit 77; }
done
mkdir -p "$work"
cd "$source"
riscv64-unknown-elf-g++ -std=c++20 -march=rv32imac -mabi=ilp32 -mcmodel=medany -Os -ffreestanding -fno-exceptions -fno-rtti \
  -fno-threadsafe-statics -fno-tree-loop-distribute-patterns -Wall -Wextra -Werror -I. -nostdlib -T tests/embedded/riscv32.ld \
  localization/landmarks/{bare_math,descriptor,descriptor_match,reductions,uncertain_pose}.cpp \
  tests/embedded/landmark_vectors.cpp tests/embedded/riscv32_start.cpp -lgcc -o "$work/landmarks.elf"
riscv64-unknown-elf-size "$work/landmarks.elf"
timeout 500 qemu-system-riscv32 -machine virt -bios none -nographic -kernel "$work/landmarks.elf" </dev/null
