/* As much of Arduino's core as the sketches need, for the emulated Cortex-M4F (board.cpp). */
#ifndef ARDUINO_H
#define ARDUINO_H
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { OUTPUT = 1, DEC = 10, HEX = 16, A0 = 14, A1 = 15 };
#define F(text) text
#define constrain(x, low, high) ((x) < (low) ? (low) : (x) > (high) ? (high) : (x))

class Print {
public:
  virtual size_t write(uint8_t byte) = 0;
  void print(char c) { write(c); }
  void print(const char *text) {
    while (*text) write(*text++);
  }
  void print(unsigned long x, int base = DEC);
  void print(unsigned x, int base = DEC) { print((unsigned long)x, base); }
  void print(int x, int base = DEC);
  void print(double x, int digits = 2);
  template <class T> void println(T x) { print(x), print("\r\n"); }
};

class Uart : public Print {
public:
  explicit constexpr Uart(uintptr_t at) : at(at) {}
  size_t write(uint8_t byte);
  void begin(unsigned long baud);
  int available();
  int read();

private:
  uintptr_t at;
};
extern Uart Serial;

unsigned long millis();
unsigned long micros();
int analogRead(uint8_t pin);
void analogWrite(uint8_t pin, int value);
void pinMode(uint8_t pin, uint8_t mode);
#endif
