@ Exception vectors and start-up, ARMv4.

    .section .vectors, "ax", %progbits
    .arm
    ldr pc, =_start
    ldr pc, =undefined_instruction
    ldr pc, =software_interrupt
    ldr pc, =prefetch_abort
    ldr pc, =data_abort
    nop
    b .
    b .
    .ltorg

    .section .text.start, "ax", %progbits
    .arm
    .global _start
_start:
    @ System mode, interrupts off. Not supervisor mode: there a semihosting
    @ call may overwrite lr.
    mrs r0, cpsr
    bic r0, r0, #0x1f
    orr r0, r0, #0xdf
    msr cpsr_c, r0
    @ Unaligned words are faults, as they are bugs on a SA-1110.
    mrc p15, 0, r0, c1, c0, 0
    orr r0, r0, #2
    mcr p15, 0, r0, c1, c0, 0
    ldr sp, =__stack_top
    ldr r0, =__bss_start
    ldr r1, =__bss_end
    mov r2, #0
1:  cmp r0, r1
    strlo r2, [r0], #4
    blo 1b
    bl start
    .ltorg

undefined_instruction:
    mov r0, #1
    b fault_entry
software_interrupt:
    mov r0, #2
    b fault_entry
prefetch_abort:
    mov r0, #3
    b fault_entry
data_abort:
    mov r0, #4
fault_entry:
    mov r1, lr
    ldr sp, =__stack_top
    bl fault
    .ltorg
