#include "client/cpp/text/table_text.h"

#include <iconv.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "client/cpp/failure.h"
#include "client/cpp/text/text.h"

namespace tribodyn::client {
namespace {

constexpr std::string_view kZipFile = "PK\x03\x04";                      // .xlsx, .ods
constexpr std::string_view kOldOfficeFile = "\xd0\xcf\x11\xe0\xa1\xb1";  // .xls

/// Converts bytes to UTF-8; returns false if they are not valid in the encoding `from`.
bool convert(const char* from, std::string_view bytes, std::string& text) {
  const iconv_t converter = iconv_open("UTF-8", from);
  if (reinterpret_cast<std::intptr_t>(converter) == -1) return false;  // iconv_open's error
  std::string in(bytes);
  text.assign(3 * bytes.size() + 4, '\0');  // 3: the longest UTF-8 of one input character
  char* source = in.data();
  char* target = text.data();
  std::size_t source_left = in.size();
  std::size_t target_left = text.size();
  const bool done = iconv(converter, &source, &source_left, &target, &target_left) !=
                    static_cast<std::size_t>(-1);
  iconv_close(converter);
  text.resize(text.size() - target_left);
  return done && source_left == 0;
}

/// Returns the variant of UTF-16 that the byte order mark or the zero bytes in the first letters of
/// the header show; null if the bytes are not UTF-16.
const char* utf16_of(std::string_view bytes) {
  if (bytes.starts_with("\xff\xfe")) return "UTF-16LE";
  if (bytes.starts_with("\xfe\xff")) return "UTF-16BE";
  if (bytes.size() < 2 || bytes.size() % 2 != 0) return nullptr;
  if (bytes[0] != '\0' && bytes[1] == '\0') return "UTF-16LE";
  if (bytes[0] == '\0' && bytes[1] != '\0') return "UTF-16BE";
  return nullptr;
}

}  // namespace

std::string table_text(const std::string& bytes, const std::string& path, std::string& note) {
  note.clear();
  if (bytes.starts_with(kZipFile) || bytes.starts_with(kOldOfficeFile)) {
    throw Failure(kExitUsage, path +
                                  " is an Excel workbook. Save it as \"CSV UTF-8 (comma "
                                  "delimited)\" and give that file");
  }
  std::string text;
  if (const char* encoding = utf16_of(bytes)) {
    std::string_view rest = bytes;
    if (rest.starts_with("\xff\xfe") || rest.starts_with("\xfe\xff")) rest.remove_prefix(2);
    if (!convert(encoding, rest, text) || text.find('\0') != std::string::npos) {
      throw Failure(kExitUsage, path + " is not a text file. Save it as \"CSV UTF-8\"");
    }
    note = path + " was read as UTF-16";
    return text;
  }
  if (bytes.find('\0') != std::string::npos) {
    throw Failure(kExitUsage,
                  path + " is not a text file (Excel workbook or UTF-16?): it contains zero bytes");
  }
  if (is_utf8(bytes)) return bytes;
  if (!convert("WINDOWS-1252", bytes, text)) {
    throw Failure(kExitUsage,
                  path + " is neither UTF-8 nor Latin-1 text. Save it as \"CSV UTF-8\"");
  }
  note = path + " was read as Latin-1 (Windows-1252). Check that its letters look right";
  return text;
}

bool is_table_file(const std::string& path) {
  std::string end = std::filesystem::path(path).extension().string();
  std::transform(end.begin(), end.end(), end.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* each : {".csv", ".tsv", ".tab", ".txt", ".xls", ".xlsx", ".xlsm", ".ods"}) {
    if (end == each) return true;
  }
  return false;
}

}  // namespace tribodyn::client
