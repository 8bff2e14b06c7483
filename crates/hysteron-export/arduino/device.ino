/* A board that the computer drives: `hysteron run` records and controls an actuator through it.
 *
 * It reads a position at A0, drives the gate of a MOSFET with PWM at pin 9, and speaks version 1 of
 * hysteron's line protocol at 115200 baud. Set the numbers below to your parts first. */
@watchdog@

// ---- Your parts ----
const char NAME[] = "wire";
const unsigned long DT_MS = 50;         // time between samples
const unsigned long WATCHDOG_MS = 1000; // silence of the computer after which the drive goes off
@parts@

enum { IDLE, RUNNING, ENDED } state;
unsigned long begun, due, heard; // times, ms
unsigned long number, applied;   // of the last sample, and of the one whose drive acts
unsigned int bad;                // lines with a wrong check
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

void end(const char *why) {
  apply(0), state = ENDED;
  line.print("E "), line.print(why), line.end();
}

// ---- What the computer says ----
void answer() {
  heard = millis();
  if (text[0] == '?') {
    apply(0), state = IDLE;
    line.print("H 1 name="), line.print(NAME);
    line.print(" dt="), line.print(DT_MS / 1000.0, 3);
    line.print(" drive=0:"), line.print(DRIVE_MOST, 3);
    line.print(" safe=0 watchdog="), line.print(WATCHDOG_MS / 1000.0, 3);
    line.print(" columns=output[mm],heat,bad_lines"), line.end();
  } else if (text[0] == 'G' && state == IDLE) {
    begun = due = millis(), number = applied = bad = 0, state = RUNNING;
  } else if (text[0] == 'Q' && state == RUNNING) {
    end("host");
  } else if (text[0] == 'D' && state == RUNNING) {
    char *rest;
    const unsigned long answered = strtoul(text + 1, &rest, 10);
    const float wanted = strtod(rest, NULL);
    if (answered <= applied || answered > number || isnan(wanted)) return; // it came too late
    apply(wanted), applied = answered;
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

void sample() {
  const float mm = read(SENSOR);
  const bool is_over = is_beyond(mm, DT_MS / 1000.0);
  line.print("S "), line.print(++number);
  line.print(' '), line.print((millis() - begun) / 1000.0, 3);
  line.print(' '), line.print(applied), line.print(' ');
  isnan(mm) ? line.print("nan") : line.print(mm, 4);
  line.print(' '), line.print(heat, 3);
  line.print(' '), line.print(bad), line.end();
  if (is_over) end("limit");
}

void setup() {
  pinMode(GATE, OUTPUT); // and low
  Serial.begin(115200);
  end("restart"); // a run that was going on learns of it
  wdt_enable(WDTO_1S); // a sketch that hangs starts again, with the drive off
}

void loop() {
  wdt_reset();
  listen();
  if (state == RUNNING && millis() - heard > WATCHDOG_MS) end("watchdog");
  if (state == RUNNING && millis() - due >= DT_MS) due += DT_MS, sample();
}
