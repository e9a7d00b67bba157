#include "server/application/guard.h"

#include <spdlog/spdlog.h>

#include <exception>
#include <new>

#include "core/refusal.h"
#include "server/application/errors.h"
#include "server/storage/store_error.h"

namespace tribodyn::server {
namespace {

/// Returns true if a call of the store failed because of its caller and not of the database.
bool is_of_the_caller(const StoreError& failure) {
  return failure.kind() == StoreError::Kind::kDeadline ||
         failure.kind() == StoreError::Kind::kCancelled;
}

}  // namespace

google::rpc::Status error_of_exception() {
  try {
    throw;
  } catch (const Refusal& refusal) {
    return refused(refusal);
  } catch (const StoreError& failure) {
    if (!is_of_the_caller(failure)) spdlog::error("{}", failure.what());
    return store_failed(failure);
  } catch (const std::bad_alloc&) {
    return out_of_memory();
  } catch (const std::exception& defect) {
    return internal_error(defect.what());
  } catch (...) {
    return internal_error("an exception of unknown type");
  }
}

}  // namespace tribodyn::server
