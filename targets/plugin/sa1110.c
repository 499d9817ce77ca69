/* Counts, under QEMU, what decides how long ARMv4 code takes on a SA-1110.

   The firmware marks what is counted by two instructions without effect:

     orr rN, rN, #0    the next reading of the timer begins an interval
     bic rN, rN, #0    a reading of the timer: begins or ends the interval

   At its end an interval becomes a line in the file given by `out=`, flushed:
   a JSON object of the counts, of how many instructions each stage had, and of
   the stage that had not returned. The caches are empty when it begins, so that
   its counts depend on nothing before it.

     entry=STAGE@ADDRESS    a function, and all that it calls, is this stage

   Stages are numbered from one; what is in none of them is stage zero. A stage
   ends where its outermost call returns to: no other one begins within it.

   What a count costs is no matter of this file: ../runner/src/cycles.rs has
   the model, and passes the delays of results as arguments, in cycles for
   which the next instruction waits if it uses the result.

     load_delay=  signed_load_delay=  multiply_delay=

   `probe=on` checks only that QEMU loads the plugin. */

#include "qemu_plugin_v1.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

EXPORT int qemu_plugin_version = 1;

_Static_assert(sizeof(void *) == 8, "a block is passed as one pointer");

/* --- counts ------------------------------------------------------------- */

/* The keys of a line. */
#define COUNTS(COUNT)                                                         \
  COUNT(instructions)                                                         \
  COUNT(multiplies)      /* with a 32-bit result */                           \
  COUNT(long_multiplies) /* with a 64-bit result */                           \
  COUNT(load_stalls)     /* cycles of waiting for a loaded register */        \
  COUNT(multiply_stalls) /* cycles of waiting for a product */                \
  COUNT(loads)           /* words, halfwords and bytes */                     \
  COUNT(stores)                                                               \
  COUNT(multiples)       /* load and store multiple instructions ... */       \
  COUNT(multiple_words)  /* ... and what they moved; in loads and stores */   \
  COUNT(taken_branches)  /* whatever instruction it was */                    \
  COUNT(fetch_misses)                                                         \
  COUNT(load_misses)                                                          \
  COUNT(store_misses)                                                         \
  COUNT(write_backs)     /* changed lines that a miss drove out */

#define FIELD(name) uint64_t name;
static struct counts { COUNTS(FIELD) } counts;

/* Words that multiples moved, by the length of their lists. */
static uint64_t words_by_list[17];

/* --- caches --------------------------------------------------------------- */

enum { LINE_BYTES = 32, WAYS = 32, MAX_SETS = 16, HINTS = 1024 };

struct cache {
  uint32_t sets;
  uint32_t line[MAX_SETS][WAYS]; /* 1 + number of the line; 0 = empty */
  bool changed[MAX_SETS][WAYS];
  uint8_t victim[MAX_SETS]; /* round robin: the way that goes next */
  uint8_t hint[HINTS];      /* where a line was found last; only for speed */
};

static struct cache instruction_cache = {.sets = 16}; /* 16 KB */
static struct cache data_cache = {.sets = 8};         /* 8 KB */

static void empty(struct cache *cache) {
  uint32_t sets = cache->sets;
  memset(cache, 0, sizeof *cache);
  cache->sets = sets;
}

/* The way that holds a line, or WAYS. */
static unsigned find(struct cache *cache, uint32_t number) {
  const uint32_t *line = cache->line[number % cache->sets];
  uint8_t *hint = &cache->hint[number % HINTS];
  if (line[*hint] == number + 1) return *hint;
  for (unsigned way = 0; way < WAYS; way++)
    if (line[way] == number + 1) return *hint = way;
  return WAYS;
}

static void fill(struct cache *cache, uint32_t number) {
  uint32_t set = number % cache->sets;
  uint8_t way = cache->victim[set];
  cache->victim[set] = (way + 1) % WAYS;
  if (cache->changed[set][way]) counts.write_backs++;
  cache->changed[set][way] = false;
  cache->line[set][way] = number + 1;
  cache->hint[number % HINTS] = way;
}

/* --- stages ----------------------------------------------------------------- */

enum { MAX_STAGES = 8, MAX_ENTRIES = 64 };

static struct entry { uint32_t address; unsigned stage; } entries[MAX_ENTRIES];
static unsigned entry_count;
static unsigned last_stage;

static uint64_t stage_instructions[MAX_STAGES];
static unsigned stage;        /* the current one */
static uint64_t stage_start;  /* instructions before it */
static uint32_t stage_return; /* where execution goes on after it */

static void switch_stage(unsigned next) {
  stage_instructions[stage] += counts.instructions - stage_start;
  stage_start = counts.instructions;
  stage = next;
}

/* The stage that begins at an address, or zero. */
static unsigned stage_at(uint32_t address) {
  for (unsigned i = 0; i < entry_count; i++)
    if (entries[i].address == address) return entries[i].stage;
  return 0;
}

/* --- execution -------------------------------------------------------------- */

static enum { IDLE, ARMED, COUNTING } state;
static uint32_t next_address; /* where execution goes on without a branch */
static FILE *out;

static void fetch(uint32_t address) {
  uint32_t number = address / LINE_BYTES;
  if (state != COUNTING) return;
  if (find(&instruction_cache, number) < WAYS) return;
  counts.fetch_misses++;
  fill(&instruction_cache, number);
}

/* The first instruction of a stage's function: a call ended the block before
   it, and returns behind that. Comes before on_block. */
static void on_entry(unsigned cpu, void *user) {
  (void)cpu;
  if (stage != 0) return;
  stage_return = next_address;
  switch_stage((uintptr_t)user);
}

/* The first instruction of a block; `user` is its length and its address. */
static void on_block(unsigned cpu, void *user) {
  (void)cpu;
  uint32_t address = (uintptr_t)user;
  uint32_t bytes = (uintptr_t)user >> 32;
  if (stage != 0 && address == stage_return) switch_stage(0);
  if (address != next_address) counts.taken_branches++;
  next_address = address + bytes;
  fetch(address);
}

/* An instruction that is the first of its line. */
static void on_line(unsigned cpu, void *user) {
  (void)cpu;
  fetch((uintptr_t)user);
}

/* An access of one register; `user` is the length of the list, 0 if none. */
static void on_access(unsigned cpu, qemu_plugin_meminfo_t info,
                      uint64_t address, void *user) {
  (void)cpu;
  uint32_t number = (uint32_t)address / LINE_BYTES;
  if (state != COUNTING) return;
  words_by_list[(uintptr_t)user]++;
  unsigned way = find(&data_cache, number);
  if (!qemu_plugin_mem_is_store(info)) {
    counts.loads++;
    if (way < WAYS) return;
    counts.load_misses++;
    fill(&data_cache, number);
  } else {
    counts.stores++;
    if (way < WAYS) data_cache.changed[number % data_cache.sets][way] = true;
    else counts.store_misses++; /* no line is allocated */
  }
}

static void on_arm(unsigned cpu, void *user) {
  (void)cpu, (void)user;
  state = ARMED;
}

static void begin(void) {
  memset(&counts, 0, sizeof counts);
  memset(words_by_list, 0, sizeof words_by_list);
  memset(stage_instructions, 0, sizeof stage_instructions);
  stage_start = 0;
  stage = 0;
  empty(&instruction_cache);
  empty(&data_cache);
  state = COUNTING;
}

static void end(void) {
  state = IDLE;
  for (unsigned length = 1; length <= 16; length++) {
    counts.multiples += words_by_list[length] / length;
    counts.multiple_words += words_by_list[length];
  }
  unsigned unfinished = stage;
  switch_stage(0);
  fputs("{\"counts\":", out);
  char separator = '{';
#define PRINT(name)                                                           \
  fprintf(out, "%c\"" #name "\":%" PRIu64, separator, counts.name);           \
  separator = ',';
  COUNTS(PRINT)
  fputs("},\"stage_instructions\":", out);
  separator = '[';
  for (unsigned i = 0; i <= last_stage; i++) {
    fprintf(out, "%c%" PRIu64, separator, stage_instructions[i]);
    separator = ',';
  }
  fprintf(out, "],\"unfinished_stage\":%u}\n", unfinished);
  fflush(out);
}

static void on_reading(unsigned cpu, void *user) {
  (void)cpu, (void)user;
  if (state == ARMED) begin();
  else if (state == COUNTING) end();
}

/* --- instructions ------------------------------------------------------------- */

static uint64_t load_delay, signed_load_delay, multiply_delay;

static uint32_t bits(uint32_t word, unsigned low, unsigned count) {
  return word >> low & ((1u << count) - 1);
}

/* The register named by four bits, as a bit of a set. */
static uint32_t reg(uint32_t word, unsigned low) {
  return 1u << bits(word, low, 4);
}

/* What an instruction does, as far as time depends on it. */
struct effect {
  uint32_t reads;   /* registers */
  uint32_t results; /* registers that come late */
  uint64_t delay;   /* how late */
  bool multiplies, is_long;
  unsigned list; /* length of a multiple's list */
};

static struct effect multiply_effect(uint32_t word) {
  bool is_long = bits(word, 23, 1), accumulates = bits(word, 21, 1);
  uint32_t low = reg(word, 12), high = reg(word, 16);
  struct effect effect = {.delay = multiply_delay,
                          .multiplies = true,
                          .is_long = is_long,
                          .reads = reg(word, 0) | reg(word, 8),
                          .results = is_long ? low | high : high};
  if (accumulates) effect.reads |= is_long ? low | high : low;
  return effect;
}

/* Halfwords, signed bytes and swaps. */
static struct effect small_transfer_effect(uint32_t word) {
  struct effect effect = {.reads = reg(word, 16)};
  bool is_swap = bits(word, 5, 2) == 0, is_signed = bits(word, 6, 1);
  if (is_swap || !bits(word, 22, 1)) effect.reads |= reg(word, 0);
  if (!is_swap && !bits(word, 20, 1)) {
    effect.reads |= reg(word, 12);
  } else {
    effect.results = reg(word, 12);
    effect.delay = is_signed ? signed_load_delay : load_delay;
  }
  return effect;
}

static struct effect transfer_effect(uint32_t word) {
  struct effect effect = {.reads = reg(word, 16)};
  if (bits(word, 25, 1)) effect.reads |= reg(word, 0);
  if (bits(word, 20, 1)) {
    effect.results = reg(word, 12);
    effect.delay = load_delay;
  } else {
    effect.reads |= reg(word, 12);
  }
  return effect;
}

static struct effect multiple_effect(uint32_t word) {
  uint32_t list = bits(word, 0, 16);
  struct effect effect = {.reads = reg(word, 16),
                          .list = __builtin_popcount(list)};
  if (!bits(word, 20, 1)) {
    effect.reads |= list;
  } else if (list != 0) { /* only the last register comes late */
    effect.results = 1u << (31 - __builtin_clz(list));
    effect.delay = load_delay;
  }
  return effect;
}

static struct effect data_effect(uint32_t word) {
  struct effect effect = {0};
  uint32_t operation = bits(word, 21, 4);
  bool is_move = operation == 13 || operation == 15;
  if (!is_move) effect.reads |= reg(word, 16);
  if (!bits(word, 25, 1)) {
    effect.reads |= reg(word, 0);
    if (bits(word, 4, 1)) effect.reads |= reg(word, 8);
  }
  return effect;
}

static struct effect effect_of(uint32_t word) {
  if ((word & 0x0fc000f0) == 0x00000090 || (word & 0x0f8000f0) == 0x00800090)
    return multiply_effect(word);
  if ((word & 0x0e000090) == 0x00000090) return small_transfer_effect(word);
  switch (bits(word, 25, 3)) {
  case 0:
  case 1: return data_effect(word);
  case 2:
  case 3: return transfer_effect(word);
  case 4: return multiple_effect(word);
  default: return (struct effect){0}; /* branches, coprocessors */
  }
}

/* orr or bic of a register with zero, into itself. */
static bool is_mark(uint32_t word, uint32_t operation) {
  return (word & 0xfff00fff) == operation &&
         bits(word, 16, 4) == bits(word, 12, 4);
}

/* --- translation ---------------------------------------------------------------- */

static void add(struct qemu_plugin_insn *insn, uint64_t *count, uint64_t n) {
  if (n == 0) return;
  qemu_plugin_register_vcpu_insn_exec_inline(insn, QEMU_PLUGIN_INLINE_ADD_U64,
                                             count, n);
}

static void call(struct qemu_plugin_insn *insn, execute_callback callback,
                 uint64_t user) {
  qemu_plugin_register_vcpu_insn_exec_cb(
      insn, callback, QEMU_PLUGIN_CB_NO_REGS, (void *)(uintptr_t)user);
}

/* When results arrive, in cycles since the block's start; every instruction
   issues in one. */
struct schedule {
  uint64_t now, ready[16];
  bool by_multiply[16];
};

/* Lets an instruction wait for what it reads, and charges it. */
static void issue(struct schedule *schedule, struct qemu_plugin_insn *insn,
                  const struct effect *effect) {
  uint64_t start = schedule->now;
  uint64_t *culprit = &counts.load_stalls;
  for (unsigned i = 0; i < 16; i++)
    if ((effect->reads >> i & 1) && schedule->ready[i] > start) {
      start = schedule->ready[i];
      culprit = schedule->by_multiply[i] ? &counts.multiply_stalls
                                         : &counts.load_stalls;
    }
  add(insn, culprit, start - schedule->now);
  schedule->now = start + 1;
  for (unsigned i = 0; i < 16; i++)
    if (effect->results >> i & 1) {
      schedule->ready[i] = schedule->now + effect->delay;
      schedule->by_multiply[i] = effect->multiplies;
    }
}

static void on_translation(qemu_plugin_id_t id, struct qemu_plugin_tb *block) {
  (void)id;
  struct schedule schedule = {0};
  size_t length = qemu_plugin_tb_n_insns(block);
  for (size_t i = 0; i < length; i++) {
    struct qemu_plugin_insn *insn = qemu_plugin_tb_get_insn(block, i);
    uint64_t address = qemu_plugin_insn_vaddr(insn);
    uint32_t word;
    memcpy(&word, qemu_plugin_insn_data(insn), sizeof word);
    struct effect effect = effect_of(word);

    if (i == 0) {
      unsigned begun = stage_at(address);
      if (begun) call(insn, on_entry, begun);
      call(insn, on_block, (uint64_t)length << 34 | address);
    } else if (address % LINE_BYTES == 0) {
      call(insn, on_line, address);
    }
    add(insn, &counts.instructions, 1);
    issue(&schedule, insn, &effect);
    if (effect.multiplies)
      add(insn, effect.is_long ? &counts.long_multiplies : &counts.multiplies,
          1);
    qemu_plugin_register_vcpu_mem_cb(insn, on_access, QEMU_PLUGIN_CB_NO_REGS,
                                     QEMU_PLUGIN_MEM_RW,
                                     (void *)(uintptr_t)effect.list);
    if (is_mark(word, 0xe3800000)) call(insn, on_arm, 0);
    if (is_mark(word, 0xe3c00000)) call(insn, on_reading, 0);
  }
}

/* --- start ---------------------------------------------------------------------- */

/* What follows `name=` in an argument, or null. */
static const char *value(const char *argument, const char *name) {
  size_t length = strlen(name);
  bool fits = strncmp(argument, name, length) == 0 && argument[length] == '=';
  return fits ? argument + length + 1 : NULL;
}

/* Takes STAGE@ADDRESS; false if it is none or one too many. */
static bool add_entry(const char *text) {
  char *rest;
  unsigned long number = strtoul(text, &rest, 10);
  if (*rest != '@' || number == 0 || number >= MAX_STAGES ||
      entry_count == MAX_ENTRIES)
    return false;
  uint32_t address = strtoul(rest + 1, &rest, 0);
  if (*rest != '\0' || rest[-1] == '@') return false;
  entries[entry_count++] = (struct entry){address, number};
  if (number > last_stage) last_stage = number;
  return true;
}

EXPORT int qemu_plugin_install(qemu_plugin_id_t id, const qemu_info_t *info,
                               int argc, char **argv) {
  (void)info;
  for (int i = 0; i < argc; i++) {
    const char *text;
    if (value(argv[i], "probe")) exit(0);
    if ((text = value(argv[i], "out"))) out = fopen(text, "w");
    if ((text = value(argv[i], "load_delay"))) load_delay = atoi(text);
    if ((text = value(argv[i], "signed_load_delay")))
      signed_load_delay = atoi(text);
    if ((text = value(argv[i], "multiply_delay")))
      multiply_delay = atoi(text);
    if ((text = value(argv[i], "entry")) && !add_entry(text)) {
      fprintf(stderr, "sa1110 plugin: %s is no STAGE@ADDRESS\n", text);
      return 1;
    }
  }
  if (!out) {
    fputs("sa1110 plugin: cannot write out=FILE\n", stderr);
    return 1;
  }
  qemu_plugin_register_vcpu_tb_trans_cb(id, on_translation);
  return 0;
}
