# Sourced by chips and learners: how to build for the emulated chips of 32 bits, and to run there.
# shellcheck shell=bash disable=SC2154 # here

declare -A prefix=([cortex-m0plus]=arm-none-eabi- [cortex-m4f]=arm-none-eabi- [rv32imac]=riscv64-unknown-elf-)
declare -A cpu=(
    [cortex-m0plus]='-mcpu=cortex-m0plus -mthumb'
    [cortex-m4f]='-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard'
    [rv32imac]='-march=rv32imac -mabi=ilp32'
)
declare -A shown=([cortex-m0plus]=Cortex-M0+ [cortex-m4f]=Cortex-M4F [rv32imac]='RISC-V, RV32IMAC')
# The M4 of the emulated board runs the code for an M0+ with as many instructions.
arm=(-nostartfiles -T "$here/../c/mps2.ld" --specs=nosys.specs -Wl,--no-warn-rwx-segments)
riscv=(--specs=picolibc.specs -nostartfiles -T "$here/rv.ld" -Wl,--no-warn-rwx-segments)
emulate() { # CHIP IMAGE
    case $1 in
        rv*) timeout 300 qemu-system-riscv32 -M virt -bios none -icount shift=0 -nographic -monitor none \
            -serial stdio -kernel "$2" < /dev/null ;;
        *) timeout 300 qemu-system-arm -M mps2-an386 -icount shift=7 -nographic -monitor none -serial stdio \
            -semihosting-config enable=on,target=native -kernel "$2" < /dev/null ;;
    esac
}
link() { # CHIP WORDS…: an image
    local chip=$1 with
    case $chip in
        rv*) with=("${riscv[@]}" "$here/rv.s") ;;
        *) with=("${arm[@]}" "$here/../c/start.c") ;;
    esac
    # shellcheck disable=SC2086 # flags are words
    "${prefix[$chip]}gcc" ${cpu[$chip]} "${@:2}" "${with[@]}"
}
