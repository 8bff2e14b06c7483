/* A board that the computer drives: `hysteron run` records and controls an actuator through it.
 *
 * It reads a position at A0, drives the gate of a MOSFET with PWM at pin 9, and speaks version 1 of
 * hysteron's line protocol at 115200 baud. Set the numbers below to your parts first. */
#if defined(__AVR__)
#include <avr/wdt.h>
#endif

// ---- Your parts ----
const char NAME[] = "wire";
const uint8_t SENSOR = A0, GATE = 9;
const unsigned long DT_MS = 50;         // time between samples
const float MM_PER_COUNT = 10.0 / 1023; // a slider of 10 mm over the whole range of the ADC
const float MM_LOW = -1, MM_HIGH = 11;  // beyond them the drive goes off
const float DRIVE_MOST = 1.0;           // the largest share of time that current may flow
const float HEAT_S = 5;                 // so many seconds of the drive are averaged ...
const float HEAT_MOST = 0.8;            // ... and where the mean comes to this, the drive goes off
const unsigned long WATCHDOG_MS = 1000; // silence of the computer after which it goes off

enum { IDLE, RUNNING, ENDED } state;
unsigned long begun, due, heard; // times, ms
unsigned long number, applied;   // of the last sample, and of the one whose drive acts
unsigned int bad;                // lines with a wrong check
float drive, heat;
char text[48]; // the line that comes
uint8_t length;

// ---- Lines with a check, CRC-16/CCITT-FALSE ----
uint16_t crc16(uint16_t crc, uint8_t byte) {
  crc ^= (uint16_t)byte << 8;
  for (uint8_t n = 0; n < 8; n++) crc = crc & 0x8000 ? (crc << 1) ^ 0x1021 : crc << 1;
  return crc;
}

/* What is printed here goes to the computer, and into the check at the end of the line. */
struct Line : public Print {
  uint16_t crc = 0xFFFF;
  size_t write(uint8_t byte) {
    crc = crc16(crc, byte);
    return Serial.write(byte);
  }
  void end() {
    Serial.print('*');
    for (int8_t shift = 12; shift >= 0; shift -= 4) Serial.print((crc >> shift) & 15, HEX);
    Serial.print('\n');
    crc = 0xFFFF;
  }
} line;

/* Cuts the check off the line that came. Whether it was right. */
bool opened() {
  char *star = strrchr(text, '*'), *rest;
  if (star == NULL || strlen(star) != 5) return false;
  uint16_t crc = 0xFFFF;
  for (const char *at = text; at < star; at++) crc = crc16(crc, *at);
  const bool right = strtoul(star + 1, &rest, 16) == crc && *rest == 0;
  *star = 0;
  return right;
}

// ---- The drive ----
void apply(float wanted) {
  drive = constrain(wanted, 0, DRIVE_MOST);
  analogWrite(GATE, (int)(drive * 255 + 0.5));
}

void end(const char *why) {
  apply(0);
  state = ENDED;
  line.print("E "), line.print(why), line.end();
}

// ---- What the computer says ----
void answer() {
  heard = millis();
  if (text[0] == '?') {
    apply(0);
    state = IDLE;
    line.print("H 1 name="), line.print(NAME);
    line.print(" dt="), line.print(DT_MS / 1000.0, 3);
    line.print(" drive=0:"), line.print(DRIVE_MOST, 3);
    line.print(" safe=0 watchdog="), line.print(WATCHDOG_MS / 1000.0, 3);
    line.print(" columns=output[mm],heat,bad_lines"), line.end();
  } else if (text[0] == 'G' && state == IDLE) {
    begun = due = millis();
    number = applied = bad = 0;
    state = RUNNING;
  } else if (text[0] == 'Q' && state == RUNNING) {
    end("host");
  } else if (text[0] == 'D' && state == RUNNING) {
    char *rest;
    const unsigned long answered = strtoul(text + 1, &rest, 10);
    const float wanted = strtod(rest, NULL);
    if (answered <= applied || answered > number || isnan(wanted)) return; // it came too late
    apply(wanted);
    applied = answered;
  }
}

void listen() {
  while (Serial.available() > 0) {
    const char c = Serial.read();
    if (c != '\n') {
      if (length < sizeof text) text[length++] = c; // a line that is too long is dropped below
      continue;
    }
    text[length < sizeof text ? length : 0] = 0;
    if (length > 0 && text[length - 1] == '\r') text[length - 1] = 0;
    length = 0;
    if (opened()) answer();
    else bad++;
  }
}

// ---- A sample ----
void sample() {
  unsigned int sum = 0, count;
  bool there = true; // with a resistor to ground, a loose slider reads zero
  for (uint8_t n = 0; n < 16; n++) sum += count = analogRead(SENSOR), there &= count > 2;
  const float mm = sum / 16.0 * MM_PER_COUNT; // the mean has less noise
  heat += (drive - heat) * (DT_MS / 1000.0) / HEAT_S;
  line.print("S "), line.print(++number);
  line.print(' '), line.print((millis() - begun) / 1000.0, 3);
  line.print(' '), line.print(applied), line.print(' ');
  there ? line.print(mm, 4) : line.print("nan");
  line.print(' '), line.print(heat, 3);
  line.print(' '), line.print(bad), line.end();
  if (heat > HEAT_MOST || (there && (mm < MM_LOW || mm > MM_HIGH))) end("limit");
}

void setup() {
  pinMode(GATE, OUTPUT); // and low
  Serial.begin(115200);
  end("restart"); // a run that was going on learns of it
#if defined(__AVR__)
  wdt_enable(WDTO_1S); // a sketch that hangs starts again, with the drive off
#endif
}

void loop() {
#if defined(__AVR__)
  wdt_reset();
#endif
  listen();
  if (state == RUNNING && millis() - heard > WATCHDOG_MS) end("watchdog");
  if (state == RUNNING && millis() - due >= DT_MS) {
    due += DT_MS;
    sample();
  }
}
