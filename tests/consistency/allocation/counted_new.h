#pragma once

namespace tribodyn {

/// Calls of any global operator new since the program began. Link counted_new.cpp.
long allocation_count();

}  // namespace tribodyn
