const uint8_t SENSOR = A0, GATE = 9;
const float DRIVE_MOST = 1.0;           // the largest share of time that current may flow
const float MM_PER_COUNT = 10.0 / 1023; // a slider of 10 mm over the whole range of the ADC
const float MM_LOW = -1, MM_HIGH = 11;  // beyond them the drive goes off
const float HEAT_S = 5;                 // so many seconds of the drive are averaged ...
const float HEAT_MOST = 0.8;            // ... and where the mean comes to this, the drive goes off
float drive, heat;                      // now

void apply(float wanted) {
  drive = constrain(wanted, 0, DRIVE_MOST);
  analogWrite(GATE, (int)(drive * 255 + 0.5));
}

/* A position, or NaN where nothing is connected: with a resistor to ground that reads zero. */
float read(uint8_t pin) {
  unsigned int sum = 0, count;
  bool there = true;
  for (uint8_t n = 0; n < 16; n++) sum += count = analogRead(pin), there &= count > 2;
  return there ? sum / 16.0 * MM_PER_COUNT : NAN; // the mean has less noise
}

/* What keeps the wire whole. Whether the drive has to go off, `seconds` after the last sample. */
bool is_beyond(float mm, float seconds) {
  heat += (drive - heat) * seconds / HEAT_S;
  return heat > HEAT_MOST || mm < MM_LOW || mm > MM_HIGH;
}
