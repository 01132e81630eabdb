#include "tests/fuzz/targets.h"

#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iostream>

namespace twinray::fuzz {
namespace {

class Folder {
  public:
    Folder() {
        std::string name = std::filesystem::is_directory("/dev/shm") ? "/dev/shm/" : "/tmp/";
        name += "twinray-fuzz-XXXXXX";
        require(mkdtemp(name.data()) != nullptr, "a folder can be made for inputs: " + name);
        path_ = name;
    }
    ~Folder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

}  // namespace

void require(bool holds, const std::string& promise) {
    if (holds) return;
    std::cerr << "fuzz: not kept: " << promise << std::endl;
    std::abort();
}

std::filesystem::path file_of(Input bytes, const std::string& name) {
    static const Folder folder;
    std::filesystem::path file = folder.path() / name;
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    require(out.flush().good(), "an input can be written: " + file.string());
    return file;
}

}  // namespace twinray::fuzz
