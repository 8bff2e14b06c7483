# The C of `@name@` as a static library. For a target that is known by name:
#     make -f @name@.mk HYS_TARGET=cortex-m4f
# For another one, with the prefix of its compiler's name, and flags that name the processor:
#     make -f @name@.mk HYS_TARGET=m7 HYS_PREFIX=arm-none-eabi- HYS_CPU=-mcpu=cortex-m7
# A Makefile that includes this file links $(@name@_library).
HYS_TARGET ?= host
HYS_OUT ?= build

HYS_PREFIX_cortex-m0plus := arm-none-eabi-
HYS_CPU_cortex-m0plus := -mcpu=cortex-m0plus -mthumb
HYS_PREFIX_cortex-m4f := arm-none-eabi-
HYS_CPU_cortex-m4f := -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard
HYS_PREFIX_rv32imac := riscv64-unknown-elf-
HYS_CPU_rv32imac := -march=rv32imac -mabi=ilp32
HYS_PREFIX_rv32imafc := riscv64-unknown-elf-
HYS_CPU_rv32imafc := -march=rv32imafc -mabi=ilp32f

HYS_PREFIX ?= $(HYS_PREFIX_$(HYS_TARGET))
HYS_CPU ?= $(HYS_CPU_$(HYS_TARGET))
ifeq ($(HYS_CPU)$(filter host,$(HYS_TARGET)),)
$(error HYS_TARGET=$(HYS_TARGET) is none of host, cortex-m0plus, cortex-m4f, rv32imac, rv32imafc: \
give HYS_PREFIX and HYS_CPU too)
endif
# Freestanding: no C library is needed. Without fused products the digits are those of the library.
HYS_FLAGS := -std=c99 -O2 -ffreestanding -ffp-contract=off -ffunction-sections -fdata-sections

@name@_folder := $(dir $(lastword $(MAKEFILE_LIST)))
@name@_objects := $(addprefix $(HYS_OUT)/$(HYS_TARGET)/@name@/,@objects@)
@name@_library := $(HYS_OUT)/$(HYS_TARGET)/libhysteron_@name@.a

$(@name@_library): $(@name@_objects)
	rm -f $@
	$(HYS_PREFIX)ar rcs $@ $^

$(HYS_OUT)/$(HYS_TARGET)/@name@/%.o: $(@name@_folder)%.c $(wildcard $(@name@_folder)*.h)
	@mkdir -p $(@D)
	$(HYS_PREFIX)gcc $(HYS_FLAGS) $(HYS_CPU) -c $< -o $@
