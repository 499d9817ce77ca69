/* sa1110.c against a QEMU made of nothing: blocks are executed by hand.
   `cargo test` compiles and runs this (../runner/tests/plugin.rs). */

#include "sa1110.c"

/* --- a stand-in for QEMU ---------------------------------------------------- */

enum { MAX_INSNS = 16, MAX_CALLS = 8 };

/* An instruction, and the accesses that it will make. */
struct step {
  uint32_t word;
  enum { NOTHING, LOAD, STORE } kind;
  uint32_t data, words;
};

struct qemu_plugin_insn {
  struct step step;
  uint64_t address;
  struct {
    execute_callback callback; /* null: add `n` to `counter` */
    void *user;
    uint64_t *counter, n;
  } calls[MAX_CALLS];
  unsigned call_count;
  memory_callback on_memory;
  void *memory_user;
};

struct qemu_plugin_tb {
  struct qemu_plugin_insn insns[MAX_INSNS];
  size_t length;
};

void qemu_plugin_register_vcpu_tb_trans_cb(qemu_plugin_id_t id,
                                           translate_callback callback) {
  (void)id, (void)callback;
}

void qemu_plugin_register_vcpu_insn_exec_cb(struct qemu_plugin_insn *insn,
                                            execute_callback callback,
                                            enum qemu_plugin_cb_flags flags,
                                            void *user) {
  (void)flags;
  insn->calls[insn->call_count].callback = callback;
  insn->calls[insn->call_count++].user = user;
}

void qemu_plugin_register_vcpu_insn_exec_inline(struct qemu_plugin_insn *insn,
                                                enum qemu_plugin_op op,
                                                void *counter, uint64_t n) {
  (void)op;
  insn->calls[insn->call_count].counter = counter;
  insn->calls[insn->call_count++].n = n;
}

void qemu_plugin_register_vcpu_mem_cb(struct qemu_plugin_insn *insn,
                                      memory_callback callback,
                                      enum qemu_plugin_cb_flags flags,
                                      enum qemu_plugin_mem_rw rw, void *user) {
  (void)flags, (void)rw;
  insn->on_memory = callback;
  insn->memory_user = user;
}

size_t qemu_plugin_tb_n_insns(const struct qemu_plugin_tb *block) {
  return block->length;
}

struct qemu_plugin_insn *qemu_plugin_tb_get_insn(
    const struct qemu_plugin_tb *block, size_t i) {
  return (struct qemu_plugin_insn *)&block->insns[i];
}

const void *qemu_plugin_insn_data(const struct qemu_plugin_insn *insn) {
  return &insn->step.word;
}

uint64_t qemu_plugin_insn_vaddr(const struct qemu_plugin_insn *insn) {
  return insn->address;
}

bool qemu_plugin_mem_is_store(qemu_plugin_meminfo_t info) {
  return info == STORE;
}

static void execute(uint32_t address, const struct step *steps,
                    size_t length) {
  struct qemu_plugin_tb block = {.length = length};
  for (size_t i = 0; i < length; i++) {
    block.insns[i].step = steps[i];
    block.insns[i].address = address + 4 * i;
  }
  on_translation(0, &block);
  for (size_t i = 0; i < length; i++) {
    struct qemu_plugin_insn *insn = &block.insns[i];
    for (unsigned c = 0; c < insn->call_count; c++)
      if (insn->calls[c].callback)
        insn->calls[c].callback(0, insn->calls[c].user);
      else
        *insn->calls[c].counter += insn->calls[c].n;
    for (uint32_t w = 0; insn->step.kind && w < insn->step.words; w++)
      insn->on_memory(0, insn->step.kind, insn->step.data + 4 * w,
                      insn->memory_user);
  }
}

/* --- the tests ---------------------------------------------------------------- */

static int failed;

#define CHECK(what, expected)                                                 \
  do {                                                                        \
    uint64_t got = (what);                                                    \
    if (got != (expected)) {                                                  \
      printf("line %d: %s is %" PRIu64 ", not %d\n", __LINE__, #what, got,    \
             (int)(expected));                                                \
      failed = 1;                                                             \
    }                                                                         \
  } while (0)

#define RUN(address, ...)                                                     \
  do {                                                                        \
    struct step steps[] = {__VA_ARGS__};                                      \
    execute(address, steps, sizeof steps / sizeof *steps);                    \
  } while (0)

/* Instructions. */
enum {
  ARM = 0xe3800000,            /* orr r0, r0, #0 */
  READING = 0xe3c33000,        /* bic r3, r3, #0 */
  LDR = 0xe5910000,            /* ldr r0, [r1] */
  LDRH = 0xe1d100b0,           /* ldrh r0, [r1] */
  LDRSH = 0xe1d100f0,          /* ldrsh r0, [r1] */
  LDRSB = 0xe1d100d0,          /* ldrsb r0, [r1] */
  LDM = 0xe8910009,            /* ldm r1, {r0, r3} */
  STR = 0xe5810000,            /* str r0, [r1] */
  STR_TO = 0xe5805000,         /* str r5, [r0] */
  STRH = 0xe1c100b0,           /* strh r0, [r1] */
  STM = 0xe8810009,            /* stm r1, {r0, r3} */
  LDR_BY = 0xe7915000,         /* ldr r5, [r1, r0] */
  LDRH_BY = 0xe19150b0,        /* ldrh r5, [r1, r0] */
  MUL = 0xe0000493,            /* mul r0, r3, r4 */
  MLA = 0xe0250493,            /* mla r5, r3, r4, r0 */
  UMULL = 0xe0820493,          /* umull r0, r2, r3, r4 */
  ADD = 0xe2805001,            /* add r5, r0, #1 */
  ADD_SHIFTED = 0xe0845100,    /* add r5, r4, r0, lsl #2 */
  ADD_SHIFTED_BY = 0xe0845016, /* add r5, r4, r6, lsl r0 */
  MOV = 0xe1a05000,            /* mov r5, r0 */
  MOV_IMMEDIATE = 0xe3a05000,  /* mov r5, #0 */
  USE_R2 = 0xe2825001,         /* add r5, r2, #1 */
  USE_R3 = 0xe2835001,         /* add r5, r3, #1 */
  OTHER = 0xe2865001,          /* add r5, r6, #1 */
};

static void start(void) {
  RUN(0x1000, {ARM}, {READING});
}

static void stop(void) {
  RUN(0x2000, {READING});
}

/* Cycles of waiting in a block of two or three instructions. */
static uint64_t stalls(uint32_t first, uint32_t second, uint32_t third) {
  start();
  RUN(0, {first}, {second}, {third});
  stop();
  return counts.load_stalls + 100 * counts.multiply_stalls;
}

static void results_are_waited_for(void) {
  CHECK(stalls(LDR, ADD, OTHER), 1);
  CHECK(stalls(LDR, OTHER, ADD), 0);
  CHECK(stalls(LDR, OTHER, OTHER), 0);
  CHECK(stalls(LDRH, ADD, OTHER), 1);
  CHECK(stalls(LDRSH, ADD, ADD), 2);
  CHECK(stalls(LDRSB, OTHER, ADD), 1);
  CHECK(stalls(LDM, USE_R3, OTHER), 1);
  CHECK(stalls(LDM, ADD, OTHER), 0);
  CHECK(stalls(MUL, ADD, OTHER), 200);
  CHECK(stalls(MUL, OTHER, ADD), 100);
  CHECK(stalls(UMULL, USE_R2, OTHER), 200);
  CHECK(stalls(UMULL, ADD, OTHER), 200);
  CHECK(stalls(LDR, MUL, OTHER), 0);
}

static void every_operand_is_seen(void) {
  uint32_t readers[] = {ADD, ADD_SHIFTED, ADD_SHIFTED_BY, MOV,    STR, STM,
                        MLA, STR_TO,      STRH,           LDR_BY, LDRH_BY};
  for (unsigned i = 0; i < sizeof readers / sizeof *readers; i++)
    CHECK(stalls(LDR, readers[i], OTHER), 1);
  CHECK(stalls(LDR, MOV_IMMEDIATE, OTHER), 0);
}

static void instructions_are_counted_by_kind(void) {
  start();
  RUN(0, {MUL}, {MLA}, {UMULL}, {LDR, LOAD, 0x100, 1}, {LDM, LOAD, 0x100, 2},
      {STM, STORE, 0x100, 2}, {STM} /* its condition failed */);
  stop();
  CHECK(counts.instructions, 8); /* with the reading */
  CHECK(counts.multiplies, 2);
  CHECK(counts.long_multiplies, 1);
  CHECK(counts.loads, 3);
  CHECK(counts.stores, 2);
  CHECK(counts.multiples, 2);
  CHECK(counts.multiple_words, 4);
}

static void branches_are_told_by_where_execution_goes_on(void) {
  start();
  RUN(0x1008, {OTHER}, {OTHER}); /* goes on */
  RUN(0x1010, {OTHER});          /* goes on */
  RUN(0x1010, {OTHER});          /* back */
  RUN(0x1020, {OTHER});          /* forth */
  RUN(0x1024, {READING});
  CHECK(counts.taken_branches, 2);
}

enum { SET_STRIDE = 8 * 32 }; /* of the data cache */

static void load(uint32_t line) {
  RUN(0, {LDR, LOAD, line * SET_STRIDE, 1});
}

static void the_data_cache_replaces_in_turn(void) {
  start();
  for (uint32_t line = 0; line < 32; line++) load(line);
  for (uint32_t line = 0; line < 32; line++) load(line);
  CHECK(counts.load_misses, 32);
  load(32); /* drives out 0, though it was used last but 31 */
  load(31);
  CHECK(counts.load_misses, 33);
  load(0); /* drives out 1 */
  load(2);
  CHECK(counts.load_misses, 34);
  load(1);
  CHECK(counts.load_misses, 35);
  stop();
  CHECK(counts.write_backs, 0);
}

static void stores_change_lines_but_allocate_none(void) {
  start();
  RUN(0, {STR, STORE, 0, 1});
  CHECK(counts.store_misses, 1);
  load(0);
  CHECK(counts.load_misses, 1);
  RUN(0, {STR, STORE, 28, 1});
  CHECK(counts.store_misses, 1);
  for (uint32_t line = 1; line <= 32; line++) load(line);
  CHECK(counts.write_backs, 1);
  for (uint32_t line = 0; line < 32; line++) load(line);
  stop();
  CHECK(counts.write_backs, 1);
}

static void fetches_are_by_line(void) {
  start();
  RUN(0x3010, {OTHER}, {OTHER}, {OTHER}, {OTHER}, {OTHER});
  CHECK(counts.fetch_misses, 2);
  RUN(0x3010, {OTHER}, {OTHER}, {OTHER}, {OTHER}, {OTHER});
  CHECK(counts.fetch_misses, 2);
  for (uint32_t line = 0; line < 32; line++) RUN(0x4000 + line * 512, {OTHER});
  CHECK(counts.fetch_misses, 34);
  RUN(0x3010, {OTHER}); /* driven out */
  CHECK(counts.fetch_misses, 35);
  stop();
}

static void marks_pair(void) {
  start();
  stop();
  CHECK(counts.instructions, 1);
  stop(); /* nothing has begun */
  CHECK(state, IDLE);
  start();
  CHECK(state, COUNTING);
  CHECK(counts.load_misses, 0);
  stop();
}

/* Numbers of instructions in stages 0 to 2, in decimal digits. */
static uint64_t by_stage(void) {
  return stage_instructions[0] * 100 + stage_instructions[1] * 10 +
         stage_instructions[2];
}

/* Code that calls the stages, at CALLER, and their functions. */
enum { CALLER = 0x5000, FIRST = 0x6000, AGAIN = 0x6100, SECOND = 0x7000 };

static void stages_end_where_they_return_to(void) {
  start();
  RUN(CALLER, {OTHER}, {OTHER});         /* and calls */
  RUN(FIRST, {OTHER}, {OTHER}, {OTHER}); /* and returns */
  RUN(CALLER + 8, {OTHER});              /* and calls */
  RUN(AGAIN, {OTHER});                   /* and returns */
  RUN(CALLER + 12, {OTHER});             /* and calls */
  RUN(SECOND, {OTHER}, {OTHER});         /* and returns */
  RUN(CALLER + 16, {OTHER});
  stop();
  CHECK(by_stage(), 642); /* 5, and the reading */
  CHECK(counts.instructions, 12);
}

static void what_a_stage_calls_is_part_of_it(void) {
  start();
  RUN(CALLER, {OTHER});
  RUN(FIRST, {OTHER});     /* calls another stage */
  RUN(SECOND, {OTHER});    /* and returns */
  RUN(FIRST + 4, {OTHER}); /* calls itself */
  RUN(FIRST, {OTHER});     /* and returns */
  RUN(FIRST + 8, {OTHER}); /* and returns */
  RUN(CALLER + 4, {OTHER});
  stop();
  CHECK(by_stage(), 350);
}

/* The line that an interval becomes ends with this. */
static void check_line_end(const char *expected) {
  char line[1024] = "", *end = line;
  rewind(out);
  while (fgets(line, sizeof line, out)) end = line + strlen(line);
  if (strcmp(end - strlen(expected), expected) != 0) {
    printf("%s does not end with %s", line, expected);
    failed = 1;
  }
}

static void a_stage_that_does_not_return_is_reported(void) {
  start();
  RUN(CALLER, {OTHER});
  RUN(FIRST, {OTHER});
  RUN(CALLER + 8, {OTHER}); /* not where it was called from */
  stop();
  check_line_end("},\"stage_instructions\":[1,3,0],\"unfinished_stage\":1}\n");
  start();
  stop();
  check_line_end("},\"stage_instructions\":[1,0,0],\"unfinished_stage\":0}\n");
}

static void entries_are_read(void) {
  CHECK(add_entry("1@0x6000"), true);
  CHECK(add_entry("1@0x6100"), true);
  CHECK(add_entry("2@0x7000"), true);
  const char *wrong[] = {"", "1", "1@", "0@0x6000", "8@0x6000", "1@0x6000x"};
  for (unsigned i = 0; i < sizeof wrong / sizeof *wrong; i++)
    CHECK(add_entry(wrong[i]), false);
  CHECK(entry_count, 3);
}

int main(void) {
  out = tmpfile();
  load_delay = 1;
  signed_load_delay = multiply_delay = 2;
  results_are_waited_for();
  every_operand_is_seen();
  instructions_are_counted_by_kind();
  branches_are_told_by_where_execution_goes_on();
  the_data_cache_replaces_in_turn();
  stores_change_lines_but_allocate_none();
  fetches_are_by_line();
  marks_pair();
  entries_are_read();
  stages_end_where_they_return_to();
  what_a_stage_calls_is_part_of_it();
  a_stage_that_does_not_return_is_reported();
  return failed;
}
