/* A board with QEMU's Cortex-M4F (mps2-an386): its first UART is the sketch's serial line, the second
 * one gets a trace. The chip has no ADC and no PWM, so the simulated spring is a part of the image:
 * `analogRead` reads its position. What it takes to compute is no time, nor is the wait for the
 * host's answer to a sample: a slow host is no delay. The trace has a row for each 10 ms: time,
 * wanted and actual position, drive.
 *
 * CUT_S and LOOSE_S: when the line is cut, and the slider comes loose. HANG_S and RESTART_S: when the
 * sketch hangs, and when the chip starts again by itself. STRENGTH: another actuator (plant.h).
 *
 * The chip's watchdog starts a sketch again after a second, with the drive off. This core switches it
 * on, and looks after it between two calls of `loop`, as cores of some boards do: the sketches know
 * that of an AVR alone. */
#include "Arduino.h"
extern "C" {
#include "../avr/plant.h"
}

#ifndef CUT_S
#define CUT_S 1e9
#endif
#ifndef LOOSE_S
#define LOOSE_S 1e9
#endif

#ifndef HANG_S
#define HANG_S 1e9
#endif
#ifndef RESTART_S
#define RESTART_S 1e9
#endif
#ifndef STRENGTH
#define STRENGTH 0
#endif

#define TIMER ((volatile uint32_t *)0x40000000u) /* 25 MHz; control, value, reload */
#define TICKS_US 25
enum { DATA, STATE, CONTROL, INTERRUPTS, DIVIDER }; /* registers of a UART */
enum { SENDING_FULL = 1, RECEIVED = 2 };
#define STEP_MS 5         /* of the spring: it computes in software */
#define PATIENCE 30000000 /* looks for an answer until the host is gone */

Uart Serial(0x40004000u);
static Uart trace(0x40005000u);
static uint32_t last; /* the timer, when it was read */
static bool at_start = true, is_sample, waits, is_gone;

/* What a restart of the chip does not touch. It lies behind the image's RAM. */
struct outside {
  plant spring;
  volatile uint64_t ticks; /* that have passed; also before a loop without end */
  unsigned long alive_ms;  /* until which the spring was computed */
  double drive;
  uint32_t is_there;       /* THERE behind the first start */
  bool had_fault;
};
#define THERE 0x600DF00Du
static outside &world = *(outside *)0x20300000u;

#define WATCHDOG ((volatile uint32_t *)0x40008000u) /* load, value, control, clear */
#define RESTART (*(volatile uint32_t *)0xE000ED0Cu)
#define HALF_S (500000u * TICKS_US) /* to the watchdog's first call, and to the second */
static void hang() {
  for (;;) {
  }
}
static void feed() { WATCHDOG[3] = 1; } /* it counts anew */

static double now_s() { return world.alive_ms / 1000.0; }

/* Goes on from here; what was between does not count. */
static void skip() { last = TIMER[1]; }

/* Brings the spring to the present time. */
static void live() {
  const uint32_t now = TIMER[1];
  world.ticks += last - now;
  while (world.alive_ms + STEP_MS <= world.ticks / (1000 * TICKS_US)) {
    plant_step(&world.spring, world.drive, STEP_MS / 1000.0);
    world.alive_ms += STEP_MS;
    if (world.alive_ms % 10 != 0) continue;
    trace.print(now_s(), 3), trace.print(','), trace.print(reference(&world.spring, now_s()), 5);
    trace.print(','), trace.print(world.spring.mm, 5), trace.print(',');
    trace.print(world.drive, 5), trace.print('\n');
  }
  skip();
}

/* The watchdog's first call: the sketch hangs. It goes on hanging until the second, and the spring
 * follows when the chip has started again. When the emulator gets to that is not the chip's time. */
extern "C" void not_masked() {
  world.ticks += last - TIMER[1] + HALF_S;
  hang();
}

unsigned long micros() {
  live();
  return (unsigned long)(world.ticks / TICKS_US);
}
unsigned long millis() { return micros() / 1000; }

int analogRead(uint8_t pin) {
  live();
  if (!world.had_fault && now_s() >= HANG_S) {
    world.had_fault = true;
    hang();
  }
  if (!world.had_fault && now_s() >= RESTART_S) {
    world.had_fault = true;
    world.drive = 0; /* a pin of a chip in reset drives no gate */
    RESTART = 0x05FA0004u;
    hang();
  }
  const double mm = pin == A1 ? reference(&world.spring, now_s()) : now_s() < LOOSE_S ? world.spring.mm : 0;
  return (int)(mm / 10 * 1023 + (double)rand() / RAND_MAX);
}
void analogWrite(uint8_t, int value) {
  live();
  world.drive = value / 255.0;
}
void pinMode(uint8_t, uint8_t) {}

void Uart::begin(unsigned long) {
  volatile uint32_t *const port = (volatile uint32_t *)at;
  port[DIVIDER] = 16;
  port[CONTROL] = 3;
}

size_t Uart::write(uint8_t byte) {
  volatile uint32_t *const port = (volatile uint32_t *)at;
  if (this == &Serial) {
    if (now_s() >= CUT_S) return 1;
    if (at_start) is_sample = byte == 'S';
    at_start = byte == '\n';
    waits = at_start && is_sample && !is_gone;
  }
  while (port[STATE] & SENDING_FULL) {
  }
  port[DATA] = byte;
  return 1;
}

int Uart::available() {
  volatile uint32_t *const port = (volatile uint32_t *)at;
  live();
  if (waits) {
    long looks = PATIENCE;
    while (!(port[STATE] & RECEIVED) && --looks > 0) feed();
    is_gone = looks == 0;
    waits = !is_gone;
    skip();
  }
  return (port[STATE] & RECEIVED) && now_s() < CUT_S;
}

int Uart::read() {
  const uint8_t byte = ((volatile uint32_t *)at)[DATA];
  is_gone = false;
  if (byte == '\n') waits = false;
  return byte;
}

void Print::print(unsigned long x, int base) {
  if (x >= (unsigned long)base) print(x / base, base);
  write("0123456789ABCDEF"[x % base]);
}
void Print::print(int x, int base) {
  if (x < 0) write('-');
  print((unsigned long)(x < 0 ? -(long)x : x), base);
}
void Print::print(double x, int digits) {
  if (isnan(x)) return print("nan");
  if (x < 0) write('-'), x = -x;
  unsigned long scale = 1;
  for (int n = 0; n < digits; n++) scale *= 10;
  const uint64_t whole = (uint64_t)(x * scale + 0.5);
  print((unsigned long)(whole / scale));
  write('.');
  for (unsigned long rest = whole % scale; scale > 1; rest %= scale) write('0' + rest / (scale /= 10));
}

void setup();
void loop();
extern "C" void (*init_start[])(void), (*init_end[])(void);

int main() {
  for (void (**init)(void) = init_start; init < init_end; init++) (*init)();
  TIMER[2] = TIMER[1] = 0xFFFFFFFFu;
  TIMER[0] = 1;
  if (world.is_there != THERE) {
    world = outside();
    world.is_there = THERE;
    plant_start(&world.spring, STRENGTH, 1);
  }
  trace.begin(0);
  skip();
  live();
  world.drive = 0; /* pins are inputs after a start */
  WATCHDOG[0] = HALF_S;
  WATCHDOG[2] = 3;
  setup();
  for (;;) {
    feed();
    loop();
  }
}
