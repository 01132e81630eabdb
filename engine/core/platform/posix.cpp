// Linux, and the parts that it shares with other systems of POSIX.
#include <dlfcn.h>
#include <fcntl.h>
#include <netdb.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <memory>

#include "engine/core/error.h"
#include "engine/core/platform.h"

namespace twinray::platform {
namespace {

namespace fs = std::filesystem;

// Returns a null-terminated list, the form in which the system takes words.
std::vector<char*> pointers_to(std::vector<std::string>& words) {
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
}

// this_program() is not used: a library that was loaded before all others may watch over the reading of links.
fs::path file_of(const Program& program) { return program.file.empty() ? "/proc/self/exe" : program.file; }

std::vector<std::string> words_of(const Program& program) {
    std::vector<std::string> words = {file_of(program).filename().string()};
    words.insert(words.end(), program.arguments.begin(), program.arguments.end());
    return words;
}

std::vector<std::string> environment_of(const Program& program) {
    std::vector<std::string> variables;
    for (char** variable = environ; *variable; ++variable) {
        const std::string name(*variable, std::string_view(*variable).find('='));
        if (!program.environment.contains(name)) variables.emplace_back(*variable);
    }
    for (const auto& [name, value] : program.environment) variables.push_back(name + '=' + value);
    return variables;
}

fs::path user_folder(const char* variable, const char* below_home) {
    if (const char* folder = std::getenv(variable); folder && *folder) return fs::path(folder) / "twinray";
    if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / below_home / "twinray";
    return {};
}

double seconds_of(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

double seconds_of(int who) {
    rusage usage{};
    getrusage(who, &usage);
    return seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
}

}  // namespace

const SystemLibrary vulkan_loader = {"libvulkan.so.1", "Debian: apt-get install libvulkan1"};
const SystemLibrary image_denoiser = {
    "libOpenImageDenoise.so.2",
    "the package pyoidn of PyPI has it; LD_LIBRARY_PATH must name its folder pyoidn/oidn/lib"};

void* open_library(const char* name) noexcept { return dlopen(name, RTLD_NOW | RTLD_LOCAL); }
void close_library(void* library) noexcept { dlclose(library); }
void* symbol_of(void* library, const char* name) noexcept { return dlsym(library, name); }

int process_id() noexcept { return getpid(); }

fs::path this_program() { return fs::read_symlink("/proc/self/exe"); }

std::optional<ProgramEnd> run_program(const Program& program) {
    std::vector<std::string> words = words_of(program), variables = environment_of(program);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    if (program.is_silent)
        for (const int output : {STDOUT_FILENO, STDERR_FILENO})
            posix_spawn_file_actions_addopen(&actions, output, "/dev/null", O_WRONLY, 0);
    pid_t child = 0;
    const int error = posix_spawnp(&child, file_of(program).c_str(), &actions, nullptr, pointers_to(words).data(),
                                   pointers_to(variables).data());
    posix_spawn_file_actions_destroy(&actions);
    int status = 0;
    if (error || waitpid(child, &status, 0) != child) return std::nullopt;
    if (WIFEXITED(status)) return ProgramEnd{WEXITSTATUS(status)};
    return ProgramEnd{128 + WTERMSIG(status), strsignal(WTERMSIG(status))};
}

void become_program(const Program& program) {
    std::vector<std::string> words = words_of(program), variables = environment_of(program);
    execvpe(file_of(program).c_str(), pointers_to(words).data(), pointers_to(variables).data());
}

std::vector<std::string> arguments_of(int count, char** words) { return {words + 1, words + count}; }

fs::path cache_folder() { return user_folder("XDG_CACHE_HOME", ".cache"); }
fs::path state_folder() { return user_folder("XDG_STATE_HOME", ".local/state"); }

fs::path make_temporary_folder() {
    std::string name = (fs::temp_directory_path() / "twinray-XXXXXX").string();
    if (!mkdtemp(name.data())) fail(name, ": no folder for temporary files; TMPDIR has to name one to write to");
    return name;
}

std::size_t terminal_width() noexcept {
    winsize size{};
    return isatty(STDOUT_FILENO) && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

bool is_error_terminal() noexcept { return isatty(STDERR_FILENO) != 0; }

bool is_mapped(std::uint64_t address) noexcept {
    const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    return msync(reinterpret_cast<void*>(address / page * page), 1, MS_ASYNC) == 0;
}

const SharedMemory shared_memory{VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME, "vkGetMemoryFdKHR",
                                 VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT, true};

std::intptr_t copy_handle(std::intptr_t handle) noexcept { return dup(static_cast<int>(handle)); }
void close_handle(std::intptr_t handle) noexcept { close(static_cast<int>(handle)); }

VkResult export_memory(PFN_vkVoidFunction get_handle, VkDevice device, VkDeviceMemory memory, std::intptr_t& handle) {
    VkMemoryGetFdInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_GET_FD_INFO_KHR;
    info.memory = memory;
    info.handleType = shared_memory.type;
    int descriptor = -1;
    const VkResult result = reinterpret_cast<PFN_vkGetMemoryFdKHR>(get_handle)(device, &info, &descriptor);
    handle = descriptor;
    return result;
}

VkResult import_memory(PFN_vkAllocateMemory allocate, VkDevice device, VkMemoryAllocateInfo info, std::intptr_t handle,
                       VkDeviceMemory& memory) {
    VkImportMemoryFdInfoKHR import{};
    import.sType = VK_STRUCTURE_TYPE_IMPORT_MEMORY_FD_INFO_KHR;
    import.pNext = info.pNext;
    import.handleType = shared_memory.type;
    import.fd = static_cast<int>(handle);
    info.pNext = &import;
    return allocate(device, &info, nullptr, &memory);
}

// proc(5): user, nice, system, idle, iowait, irq, softirq, steal, in ticks; the others are in user already.
std::optional<ProcessorSeconds> processor_seconds() {
    std::ifstream file("/proc/stat");
    std::string name;
    double ticks[8] = {};
    file >> name;
    for (double& tick : ticks) file >> tick;
    if (!file || name != "cpu") return std::nullopt;
    const double per_second = static_cast<double>(sysconf(_SC_CLK_TCK));
    ProcessorSeconds seconds{.own = seconds_of(RUSAGE_SELF) + seconds_of(RUSAGE_CHILDREN)};
    for (const double tick : ticks) seconds.all += tick / per_second;
    seconds.busy = seconds.all - (ticks[3] + ticks[4]) / per_second;
    return seconds;
}

std::optional<Connection> Connection::open(const std::string& host, const std::string& port, int patience_seconds) {
    addrinfo hints{}, *found = nullptr;
    hints.ai_socktype = SOCK_STREAM;
    if (getaddrinfo(host.c_str(), port.c_str(), &hints, &found) != 0) return std::nullopt;
    const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> all(found, &freeaddrinfo);
    for (const addrinfo* one = all.get(); one; one = one->ai_next) {
        const int made = socket(one->ai_family, one->ai_socktype, one->ai_protocol);
        if (made < 0) continue;
        Connection connection(made);
        const timeval patience{.tv_sec = patience_seconds, .tv_usec = 0};
        setsockopt(made, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
        if (connect(made, one->ai_addr, one->ai_addrlen) == 0) return connection;
    }
    return std::nullopt;
}

Connection::~Connection() {
    if (socket_ != none) close(static_cast<int>(socket_));
}

bool Connection::send(std::string_view bytes) noexcept {
    for (std::size_t sent = 0; sent < bytes.size();) {
        const ssize_t count = ::send(static_cast<int>(socket_), bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
        if (count <= 0) return false;
        sent += static_cast<std::size_t>(count);
    }
    return true;
}

}  // namespace twinray::platform
