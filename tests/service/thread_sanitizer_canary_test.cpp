// A planted data race. The test passes only when ThreadSanitizer reports it: a sanitizer build that
// finds nothing here would find nothing anywhere.
#include <iostream>
#include <thread>

int main() {
  int shared = 0;
  std::thread other([&shared] { ++shared; });
  ++shared;
  other.join();
  std::cout << shared << '\n';
  return 0;
}
