#include "tests/crash/faulty_vfs.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <new>

namespace tribodyn::crash {

/// SQLite allocates it together with the file of the real file system, which follows it in memory.
struct FaultyFile {
  sqlite3_file file;
  FaultyVfs* vfs;
  std::string* path;

  sqlite3_file* base() { return reinterpret_cast<sqlite3_file*>(this + 1); }
  static FaultyFile& of(sqlite3_file* file) { return *reinterpret_cast<FaultyFile*>(file); }

  static int close(sqlite3_file* file) {
    FaultyFile& self = of(file);
    delete self.path;
    return self.base()->pMethods->xClose(self.base());
  }
  static int read(sqlite3_file* file, void* bytes, int count, sqlite3_int64 offset) {
    FaultyFile& self = of(file);
    const int due = self.vfs->attempt(FaultyVfs::Operation::kRead, SQLITE_IOERR_READ);
    if (due != SQLITE_OK) return due;
    return self.base()->pMethods->xRead(self.base(), bytes, count, offset);
  }
  static int write(sqlite3_file* file, const void* bytes, int count, sqlite3_int64 offset) {
    FaultyFile& self = of(file);
    const int due = self.vfs->attempt(FaultyVfs::Operation::kWrite, SQLITE_IOERR_WRITE, count);
    if (due != SQLITE_OK) return due;
    const char* begin = static_cast<const char*>(bytes);
    self.vfs->note_change(*self.path, {offset, {begin, begin + count}});
    return self.base()->pMethods->xWrite(self.base(), bytes, count, offset);
  }
  static int truncate(sqlite3_file* file, sqlite3_int64 size) {
    FaultyFile& self = of(file);
    const int due = self.vfs->attempt(FaultyVfs::Operation::kWrite, SQLITE_IOERR_TRUNCATE);
    if (due != SQLITE_OK) return due;
    self.vfs->note_change(*self.path, {size, {}});
    return self.base()->pMethods->xTruncate(self.base(), size);
  }
  static int sync(sqlite3_file* file, int flags) {
    FaultyFile& self = of(file);
    const int due = self.vfs->attempt(FaultyVfs::Operation::kSync, SQLITE_IOERR_FSYNC);
    if (due != SQLITE_OK) return due;
    self.vfs->note_sync(*self.path);
    const int done = self.base()->pMethods->xSync(self.base(), flags);
    if (const auto action = self.vfs->sync_action()) action();
    return done;
  }
  static int size(sqlite3_file* file, sqlite3_int64* out) {
    return of(file).base()->pMethods->xFileSize(of(file).base(), out);
  }
  static int lock(sqlite3_file* file, int level) {
    return of(file).base()->pMethods->xLock(of(file).base(), level);
  }
  static int unlock(sqlite3_file* file, int level) {
    return of(file).base()->pMethods->xUnlock(of(file).base(), level);
  }
  static int check_lock(sqlite3_file* file, int* out) {
    return of(file).base()->pMethods->xCheckReservedLock(of(file).base(), out);
  }
  static int control(sqlite3_file* file, int operation, void* argument) {
    return of(file).base()->pMethods->xFileControl(of(file).base(), operation, argument);
  }
  static int sector_size(sqlite3_file* file) {
    return of(file).base()->pMethods->xSectorSize(of(file).base());
  }
  static int characteristics(sqlite3_file* file) {
    return of(file).base()->pMethods->xDeviceCharacteristics(of(file).base());
  }
  static int shm_map(sqlite3_file* file, int page, int size, int extend, void volatile** out) {
    return of(file).base()->pMethods->xShmMap(of(file).base(), page, size, extend, out);
  }
  static int shm_lock(sqlite3_file* file, int offset, int count, int flags) {
    return of(file).base()->pMethods->xShmLock(of(file).base(), offset, count, flags);
  }
  static void shm_barrier(sqlite3_file* file) {
    of(file).base()->pMethods->xShmBarrier(of(file).base());
  }
  static int shm_unmap(sqlite3_file* file, int remove) {
    return of(file).base()->pMethods->xShmUnmap(of(file).base(), remove);
  }
};

namespace {

constexpr char kName[] = "tribodyn-faulty";
constexpr std::int64_t kSector = 512;

std::vector<char> contents_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void apply(std::int64_t offset, const std::vector<char>& bytes, std::vector<char>& file) {
  const auto begin = static_cast<std::size_t>(offset);
  if (bytes.empty()) return file.resize(begin);
  file.resize(std::max(file.size(), begin + bytes.size()));
  std::copy(bytes.begin(), bytes.end(), file.begin() + offset);
}

}  // namespace

FaultyVfs::FaultyVfs() : base_(sqlite3_vfs_find(nullptr)), vfs_(*base_) {
  vfs_.zName = kName;
  vfs_.pAppData = this;
  vfs_.szOsFile = static_cast<int>(sizeof(FaultyFile)) + base_->szOsFile;
  vfs_.xOpen = open;
  vfs_.xDelete = remove;
  methods_ = {.iVersion = 2,  // no memory maps
              .xClose = FaultyFile::close,
              .xRead = FaultyFile::read,
              .xWrite = FaultyFile::write,
              .xTruncate = FaultyFile::truncate,
              .xSync = FaultyFile::sync,
              .xFileSize = FaultyFile::size,
              .xLock = FaultyFile::lock,
              .xUnlock = FaultyFile::unlock,
              .xCheckReservedLock = FaultyFile::check_lock,
              .xFileControl = FaultyFile::control,
              .xSectorSize = FaultyFile::sector_size,
              .xDeviceCharacteristics = FaultyFile::characteristics,
              .xShmMap = FaultyFile::shm_map,
              .xShmLock = FaultyFile::shm_lock,
              .xShmBarrier = FaultyFile::shm_barrier,
              .xShmUnmap = FaultyFile::shm_unmap,
              .xFetch = nullptr,
              .xUnfetch = nullptr};
  sqlite3_vfs_register(&vfs_, 1);
}

FaultyVfs::~FaultyVfs() {
  sqlite3_vfs_unregister(&vfs_);
  sqlite3_vfs_register(base_, 1);
}

int FaultyVfs::open(sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags,
                    int* out_flags) {
  auto* self = static_cast<FaultyVfs*>(vfs->pAppData);
  FaultyFile& opened = FaultyFile::of(file);
  opened.file.pMethods = nullptr;
  if (name != nullptr) {
    const int due = self->attempt(Operation::kOpen, SQLITE_CANTOPEN);
    if (due != SQLITE_OK) return due;
  }
  const int status = self->base_->xOpen(self->base_, name, opened.base(), flags, out_flags);
  if (status != SQLITE_OK) return status;
  opened.vfs = self;
  opened.path = new std::string(name == nullptr ? "" : name);
  opened.file.pMethods = &self->methods_;
  if (name != nullptr) self->note_open(name);
  return SQLITE_OK;
}

int FaultyVfs::remove(sqlite3_vfs* vfs, const char* name, int sync_folder) {
  auto* self = static_cast<FaultyVfs*>(vfs->pAppData);
  const int due = self->attempt(Operation::kWrite, SQLITE_IOERR_DELETE);
  if (due != SQLITE_OK) return due;
  {
    const std::lock_guard lock(self->mutex_);
    self->files_.erase(name);
  }
  return self->base_->xDelete(self->base_, name, sync_folder);
}

void FaultyVfs::begin_plan() {
  std::fill(std::begin(counts_), std::end(counts_), 0);
  std::fill(std::begin(fail_at_), std::end(fail_at_), 0);
  written_ = 0;
  power_off_at_ = 0;
  lasting_ = false;
  after_sync_ = nullptr;
  space_ = std::numeric_limits<std::int64_t>::max();
}

void FaultyVfs::fail(Operation operation, int n, bool lasting) {
  const std::lock_guard lock(mutex_);
  begin_plan();
  fail_at_[static_cast<int>(operation)] = n;
  lasting_ = lasting;
}

void FaultyVfs::lose_power_at(int n) {
  const std::lock_guard lock(mutex_);
  begin_plan();
  power_off_at_ = n;
}

void FaultyVfs::limit_space(std::int64_t bytes) {
  const std::lock_guard lock(mutex_);
  begin_plan();
  space_ = bytes;
}

void FaultyVfs::ignore_syncs() {
  const std::lock_guard lock(mutex_);
  ignores_syncs_ = true;
}

void FaultyVfs::after_sync(std::function<void()> action) {
  const std::lock_guard lock(mutex_);
  begin_plan();
  after_sync_ = std::move(action);
}

std::function<void()> FaultyVfs::sync_action() const {
  const std::lock_guard lock(mutex_);
  return after_sync_;
}

void FaultyVfs::recover() {
  const std::lock_guard lock(mutex_);
  begin_plan();
}

int FaultyVfs::count(Operation operation) const {
  const std::lock_guard lock(mutex_);
  return counts_[static_cast<int>(operation)];
}

int FaultyVfs::count() const {
  const std::lock_guard lock(mutex_);
  return operations_without_reads();
}

int FaultyVfs::operations_without_reads() const {
  int all = 0;
  for (const int each : counts_) all += each;
  return all - counts_[static_cast<int>(Operation::kRead)];
}

std::int64_t FaultyVfs::written_bytes() const {
  const std::lock_guard lock(mutex_);
  return written_;
}

int FaultyVfs::attempt(Operation operation, int error, std::int64_t bytes) {
  const std::lock_guard lock(mutex_);
  const int index = static_cast<int>(operation);
  const int now = ++counts_[index];
  const bool off = power_off_at_ > 0 && operations_without_reads() >= power_off_at_;
  if (off && operation != Operation::kRead) return error;
  if (fail_at_[index] > 0 && (now == fail_at_[index] || (lasting_ && now > fail_at_[index]))) {
    return error;
  }
  if (written_ + bytes > space_) return SQLITE_FULL;
  written_ += bytes;
  return SQLITE_OK;
}

void FaultyVfs::note_open(const std::string& path) {
  const std::lock_guard lock(mutex_);
  if (!files_.contains(path)) files_[path].durable = contents_of(path);
}

void FaultyVfs::note_change(const std::string& path, Change change) {
  const std::lock_guard lock(mutex_);
  const auto found = files_.find(path);
  if (found != files_.end()) found->second.unsynced.push_back(std::move(change));
}

void FaultyVfs::note_sync(const std::string& path) {
  const std::lock_guard lock(mutex_);
  const auto found = files_.find(path);
  if (found == files_.end() || ignores_syncs_) return;
  for (const Change& each : found->second.unsynced) {
    apply(each.offset, each.bytes, found->second.durable);
  }
  found->second.unsynced.clear();
}

void FaultyVfs::drop_unsynced(std::mt19937_64& random) {
  const std::lock_guard lock(mutex_);
  for (auto& [path, contents] : files_) {
    for (const Change& each : contents.unsynced) {
      if (each.bytes.empty()) {
        if (random() % 2 == 0) apply(each.offset, each.bytes, contents.durable);
        continue;
      }
      const auto kind = random() % 3;  // nothing, everything, or some of its sectors
      const auto size = static_cast<std::int64_t>(each.bytes.size());
      for (std::int64_t at = 0; at < size; at += kSector) {
        if (kind == 0 || (kind == 2 && random() % 2 == 0)) continue;
        const auto end = std::min(at + kSector, size);
        apply(each.offset + at, {each.bytes.begin() + at, each.bytes.begin() + end},
              contents.durable);
      }
    }
    std::ofstream(path, std::ios::binary | std::ios::trunc)
        .write(contents.durable.data(), static_cast<std::streamsize>(contents.durable.size()));
  }
  files_.clear();
}

}  // namespace tribodyn::crash
