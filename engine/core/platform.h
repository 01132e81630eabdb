// Everything that systems do in different ways. platform/posix.cpp and platform/windows.cpp define it; no other file
// includes a header of one system or asks which one it is compiled for. All text is UTF-8.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <vulkan/vulkan_core.h>

namespace twinray::platform {

// Libraries. open_library returns null if no library has that name; symbol_of, if the library lacks the symbol.
void* open_library(const char* name) noexcept;
void close_library(void* library) noexcept;
void* symbol_of(void* library, const char* name) noexcept;

struct SystemLibrary {
    const char* library;
    const char* hint;  // how to get it
};
extern const SystemLibrary vulkan_loader, image_denoiser;

// Processes.
int process_id() noexcept;
std::filesystem::path this_program();

struct Program {
    std::filesystem::path file;  // without a folder, it is looked up in the search path; empty: this program
    std::vector<std::string> arguments = {};
    std::map<std::string, std::string> environment = {};  // changes of this process's
    bool is_silent = false;                               // its output is dropped
};
struct ProgramEnd {
    int status = 0;
    std::string fault = {};  // the signal or exception by which the system ended it; else empty
};
// Waits for its end. Returns nothing if it cannot be started.
std::optional<ProgramEnd> run_program(const Program& program);
// Replaces this process by the program, or ends it with the program's status. Returns only if it cannot be started.
void become_program(const Program& program);

// Returns the words after the program's name, or the last of them, given what main got. From then on a console shows
// UTF-8, and lines end by LF in all that the program writes.
std::vector<std::string> arguments_of(int count, char** words);

// Returns the file that text in UTF-8 names: Windows takes plain text for letters of one byte.
inline std::filesystem::path path_of(std::string_view text) { return std::u8string(text.begin(), text.end()); }

// Return the user's folders for twinray's files; empty if the environment names none. They need not exist.
std::filesystem::path cache_folder();
std::filesystem::path state_folder();
// Makes a new folder that other users cannot read. Throws Error naming the path at which it cannot be made.
std::filesystem::path make_temporary_folder();

// Return the columns of the terminal, 0 if the standard output is none; and whether the error output is a terminal that
// understands escape sequences.
std::size_t terminal_width() noexcept;
bool is_error_terminal() noexcept;

// Returns whether this process has memory there.
bool is_mapped(std::uint64_t address) noexcept;

// Device memory that programs and APIs share, by a file descriptor or a handle of Windows, and how Vulkan exports it.
struct SharedMemory {
    const char* extension;
    const char* get_handle;  // the function of a device that exports
    VkExternalMemoryHandleTypeFlagBits type;
    bool is_taken_over;  // by an import
};
extern const SharedMemory shared_memory;
constexpr std::intptr_t no_handle = -1;
// Returns no_handle if that is none.
std::intptr_t copy_handle(std::intptr_t handle) noexcept;
void close_handle(std::intptr_t handle) noexcept;
// `get_handle` is the device's function of that name. Returns VK_SUCCESS and a new handle, or the function's result.
VkResult export_memory(PFN_vkVoidFunction get_handle, VkDevice device, VkDeviceMemory memory, std::intptr_t& handle);
// Allocates with `info`, to whose chain it adds the import of the handle.
VkResult import_memory(PFN_vkAllocateMemory allocate, VkDevice device, VkMemoryAllocateInfo info, std::intptr_t handle,
                       VkDeviceMemory& memory);

// Seconds since the system started, of all processors together, and those of this process and its ended children.
struct ProcessorSeconds {
    double all = 0, busy = 0, own = 0;
};
// Returns nothing if the system does not tell.
std::optional<ProcessorSeconds> processor_seconds();

// A stream of bytes to a server.
class Connection {
  public:
    // Returns nothing if nobody listens there. A server that does not read for `patience_seconds` counts as gone.
    static std::optional<Connection> open(const std::string& host, const std::string& port, int patience_seconds);
    Connection(Connection&& other) noexcept : socket_(std::exchange(other.socket_, none)) {}
    Connection& operator=(Connection&& other) noexcept {
        std::swap(socket_, other.socket_);
        return *this;
    }
    ~Connection();

    // Returns false once the server is gone.
    bool send(std::string_view bytes) noexcept;

  private:
    static constexpr std::intptr_t none = -1;
    explicit Connection(std::intptr_t socket) : socket_(socket) {}

    std::intptr_t socket_;
};

}  // namespace twinray::platform
