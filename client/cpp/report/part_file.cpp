#include "client/cpp/report/part_file.h"

#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "client/cpp/failure.h"

namespace tribodyn::client {
namespace {

constexpr std::size_t kIdentityLength = 12;

}  // namespace

bool PartFile::is_stream(const std::string& path) {
  struct stat info;
  return stat(path.c_str(), &info) == 0 && !S_ISREG(info.st_mode);
}

PartFile::PartFile(std::string path, const std::string& identity, const std::string& header,
                   std::size_t row_bytes)
    : path_(std::move(path)), target_(path_) {
  if (!is_stream(path_)) {
    target_ = path_ + "." + identity.substr(0, kIdentityLength) + ".part";
    rows_there_ = rows_of_part(header, row_bytes);
  }
  file_.open(target_, std::ios::binary | (rows_there_ > 0 ? std::ios::app : std::ios::trunc));
  if (rows_there_ == 0) file_ << header;
  check();
}

/// Removes an incomplete last row and returns the number of complete rows.
std::int64_t PartFile::rows_of_part(const std::string& header, std::size_t row_bytes) const {
  std::ifstream part(target_, std::ios::binary);
  std::string begin(header.size(), '\0');
  if (!part.read(begin.data(), static_cast<std::streamsize>(begin.size())) || begin != header) {
    return 0;
  }
  std::int64_t rows = 0;
  std::uintmax_t end = header.size();
  if (row_bytes > 0) {
    const std::uintmax_t width = row_bytes;
    rows = static_cast<std::int64_t>((std::filesystem::file_size(target_) - end) / width);
    end += static_cast<std::uintmax_t>(rows) * width;
  } else {
    for (std::string line; std::getline(part, line) && !part.eof(); ++rows) end += line.size() + 1;
  }
  part.close();
  std::filesystem::resize_file(target_, end);
  return rows;
}

void PartFile::add(const std::string& rows) {
  file_ << rows << std::flush;
  check();
}

void PartFile::finish() {
  file_.close();
  check();
  if (target_ == path_) return;
  if (std::rename(target_.c_str(), path_.c_str()) != 0) {
    throw Failure(kExitFailed, "cannot write " + path_ + ": " + std::strerror(errno));
  }
}

void PartFile::discard() {
  file_.close();
  std::error_code ignored;
  if (target_ != path_) std::filesystem::remove(target_, ignored);
}

void PartFile::check() {
  if (!file_) throw Failure(kExitFailed, "cannot write " + target_ + ": " + std::strerror(errno));
}

}  // namespace tribodyn::client
