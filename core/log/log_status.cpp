#include "core/log/log_status.hpp"

#include <H5Cpp.h>

#include <algorithm>
#include <fstream>
#include <vector>

#include "core/log/hdf5_error.hpp"

namespace hagfish {
namespace {

constexpr std::size_t memory_increment = 4096;  // by which the file grows in memory, bytes

/// The bytes of `file` with another status; changed in memory, where nothing can run out half-way.
std::vector<char> with_status(const std::filesystem::path& file, const std::string& status) {
  H5::FileAccPropList in_memory;
  in_memory.setCore(memory_increment, false);
  const H5::H5File h5(file.string(), H5F_ACC_RDWR, H5::FileCreatPropList::DEFAULT, in_memory);
  const H5::Attribute attribute = h5.openGroup("/").openAttribute("status");
  attribute.write(attribute.getDataType(), status);
  h5.flush(H5F_SCOPE_GLOBAL);
  std::vector<char> bytes(static_cast<std::size_t>(h5.getFileSize()));
  if (H5Fget_file_image(h5.getId(), bytes.data(), bytes.size()) < 0) {
    throw H5::FileIException("H5Fget_file_image", "no image");
  }
  return bytes;
}

}  // namespace

bool set_status_in_place(const std::filesystem::path& file, const std::string& status) {
  H5::Exception::dontPrint();
  try {
    const std::vector<char> changed = with_status(file, status);
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    std::vector<char> before(changed.size());
    stream.read(before.data(), static_cast<std::streamsize>(before.size()));
    if (!stream) {
      return false;  // it has grown
    }
    for (auto at = changed.begin(); at != changed.end();) {
      const auto differs =
          std::mismatch(at, changed.end(), before.begin() + (at - changed.begin()));
      if (differs.first == changed.end()) {
        break;
      }
      stream.seekp(differs.first - changed.begin());
      stream.put(*differs.first);
      at = differs.first + 1;
    }
    stream.close();
    return !stream.fail();
  } catch (const H5::Exception&) {
    return false;
  }
}

}  // namespace hagfish
