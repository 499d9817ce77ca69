# Which source lines lead to which panic: reads `llvm-objdump -dl --demangle
# --no-show-raw-insn` of an image. A panic call stands in a block that nothing
# falls into; the lines sought are those of the branches to that block.

# Instructions between a block's start and its call, at most.
BEGIN { block = 6 }

/^[0-9a-f]+ <.*>:$/ { in_panicking = /<core::panicking/ }
/^; .*\.rs:[0-9]+$/ { line = $2 }
/^ *[0-9a-f]+:/ && !in_panicking {
  address = $1
  sub(/:/, "", address)
  number[address] = ++count
  text[count] = $0
  source[count] = line
}

END {
  for (call = 1; call <= count; call++) {
    if (text[call] !~ /\tbl?(\.w)?\t.*<core::.*(panic|fail)/) continue
    panic = text[call]
    sub(/.*</, "", panic)
    sub(/>.*/, "", panic)
    found = 0
    for (branch = 1; branch <= count; branch++) {
      if (text[branch] !~ /\tc?b[a-z.]*\t.*0x[0-9a-f]+ </) continue
      target = text[branch]
      sub(/ <.*/, "", target)
      sub(/.*0x/, "", target)
      start = number[target]
      if (start && start <= call && start > call - block) {
        print "  " source[branch] ": " panic
        found = 1
      }
    }
    if (!found) print "  " source[call] ": " panic
  }
}
