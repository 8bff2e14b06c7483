/* A position that holds, on the board alone: a knob says where, the inverse of the model and a PID
 * bring the actuator there.
 *
 * The slider is read at A0, the knob at A1, and PWM at pin 9 drives the gate of a MOSFET. Set the
 * numbers below to your parts first. Tools > Serial Plotter shows wanted, position and drive. */
#include <@name@.h>
@watchdog@
@board@

// ---- Your parts: as in the sketch `device`, which the model was recorded with ----
const uint8_t KNOB = A1;                // a potentiometer that is read as the slider
const float LOWEST = @lowest@, HIGHEST = @highest@; // where the knob may lead: the model's range
@parts@

// ---- The model: its inverse, and what follows the drive, each with its memory ----
@states@
hys_controller controller;
hys_real under_way[@NAME@_LATE + 1];

const unsigned long DT_US = @name@_control.dt * 1e6 + 0.5;
unsigned long due;
uint8_t unsaid;        // samples since the last line
unsigned int overruns; // samples that came too late
bool is_off = false;
float at = NAN, speed; // the knob, and how far it goes in a sample

/* Follows the knob without its noise, which the inverse would answer with large drives. */
void follow(float knob) {
  if (isnan(knob) || isnan(at)) at = knob, speed = 0;
  at += speed;
  const float off = knob - at;
  at += 0.3 * off;
  speed += 0.05 * off;
}

void setup() {
  pinMode(GATE, OUTPUT);
  apply(0);
  Serial.begin(115200);
@start@
  is_off |= hys_controller_start(&controller, &@name@_control, @wanted@, @followed@, under_way,
                                 @NAME@_LATE + 1) != HYS_OK;
  is_off |= hys_controller_go_on_from(&controller, 0) != HYS_OK;
@shadow_start@
  // After a restart the wire may be hot, and the model starts cold: it begins when both are.
  due = micros() + (unsigned long)(HEAT_S * 1e6);
  wdt_enable(WDTO_1S); // a sketch that hangs starts again, with the drive off
}

void loop() {
  wdt_reset();
  if ((long)(micros() - due) < (long)DT_US) return;
  due += DT_US;
  if (micros() - due >= DT_US) overruns++;

  const float mm = read(SENSOR);
  follow(read(KNOB));
  const float wanted = isnan(at) ? LOWEST : constrain(at, LOWEST, HIGHEST);
  const float ahead = isnan(at) ? LOWEST : constrain(at + speed, LOWEST, HIGHEST);
  hys_action action;
  const int code = hys_controller_step(&controller, wanted, ahead, HYS_HOLD, mm, &action);
  if (code != HYS_OK) is_off = true;

  // Off is off, until the board is started again.
  if (is_beyond(mm, DT_US * 1e-6)) is_off = true;
  if (action.status & HYS_SAFE) is_off = true; // no reading, or one that stands still
@shadow_step@
  apply(is_off ? 0 : action.drive);

  if (++unsaid == 5) {
    unsaid = 0;
    Serial.print(F("wanted:")), Serial.print(wanted, 3);
    Serial.print(F(" position:")), Serial.print(mm, 3);
    Serial.print(F(" drive:")), Serial.print(drive, 3);
@shadow_print@
    Serial.print(F(" off:")), Serial.print(is_off);
    Serial.print(F(" overruns:")), Serial.println(overruns);
  }
}
