#include "client/cpp/text/colour.h"

#include <unistd.h>

#include <cstdlib>
#include <string_view>

namespace tribodyn::client {
namespace {

bool colours_on_output = false;
bool colours_on_errors = false;

bool wants_colours(ColourChoice choice, int descriptor) {
  if (choice != ColourChoice::kAuto) return choice == ColourChoice::kAlways;
  const char* no_color = std::getenv("NO_COLOR");
  if (no_color != nullptr && *no_color != '\0') return false;
  const char* term = std::getenv("TERM");
  return isatty(descriptor) != 0 && term != nullptr && std::string_view(term) != "dumb";
}

std::string painted(bool on, const char* code, const std::string& text) {
  return on && !text.empty() ? std::string("\x1b[") + code + "m" + text + "\x1b[0m" : text;
}

}  // namespace

void set_colours(ColourChoice choice) {
  colours_on_output = wants_colours(choice, STDOUT_FILENO);
  colours_on_errors = wants_colours(choice, STDERR_FILENO);
}

std::string heading(const std::string& text) { return painted(colours_on_output, "1", text); }
std::string caution(const std::string& text) { return painted(colours_on_output, "33", text); }
std::string alarm(const std::string& text) { return painted(colours_on_errors, "1;31", text); }

}  // namespace tribodyn::client
