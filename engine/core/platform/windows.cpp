// Windows 10 and later.
#define NOMINMAX
#define WIN32_LEAN_AND_MEAN
#undef _WIN32_WINNT
#define _WIN32_WINNT 0x0A00
#include <winsock2.h>
#include <ws2tcpip.h>
// The two above come first.
#include <fcntl.h>
#include <io.h>
#include <shellapi.h>
#include <windows.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <random>

#include "engine/core/error.h"
#include "engine/core/platform.h"
// It needs windows.h.
#include <vulkan/vulkan_win32.h>

namespace twinray::platform {
namespace {

namespace fs = std::filesystem;

std::wstring wide(std::string_view text) {
    const int bytes = static_cast<int>(text.size());
    std::wstring result(static_cast<std::size_t>(MultiByteToWideChar(CP_UTF8, 0, text.data(), bytes, nullptr, 0)), 0);
    MultiByteToWideChar(CP_UTF8, 0, text.data(), bytes, result.data(), static_cast<int>(result.size()));
    return result;
}

std::string narrow(std::wstring_view text) {
    const int words = static_cast<int>(text.size());
    const int bytes = WideCharToMultiByte(CP_UTF8, 0, text.data(), words, nullptr, 0, nullptr, nullptr);
    std::string result(static_cast<std::size_t>(bytes), 0);
    WideCharToMultiByte(CP_UTF8, 0, text.data(), words, result.data(), bytes, nullptr, nullptr);
    return result;
}

// Escapes the word for a program's start, which takes it apart: a backslash means itself unless it is before a quote.
std::wstring escaped(std::wstring_view word) {
    if (!word.empty() && word.find_first_of(L" \t\n\v\"") == word.npos) return std::wstring(word);
    std::wstring result = L"\"";
    std::size_t backslashes = 0;
    for (const wchar_t c : word) {
        if (c == L'"') result.append(backslashes + 1, L'\\');
        backslashes = c == L'\\' ? backslashes + 1 : 0;
        result += c;
    }
    return result.append(backslashes, L'\\') + L'"';
}

std::wstring command_line(const Program& program) {
    std::wstring line = escaped((program.file.empty() ? this_program() : program.file).wstring());
    for (const std::string& argument : program.arguments) line += L' ' + escaped(wide(argument));
    return line;
}

// Names of variables differ in more than the case of their letters.
struct OtherName {
    bool operator()(const std::wstring& a, const std::wstring& b) const {
        return CompareStringOrdinal(a.c_str(), -1, b.c_str(), -1, TRUE) == CSTR_LESS_THAN;
    }
};

// Variables end with a null, all of them with another.
std::wstring environment_of(const Program& program) {
    std::map<std::wstring, std::wstring, OtherName> variables;
    const std::unique_ptr<wchar_t, decltype(&FreeEnvironmentStringsW)> block(GetEnvironmentStringsW(),
                                                                             &FreeEnvironmentStringsW);
    for (const wchar_t* variable = block.get(); *variable; variable += std::wcslen(variable) + 1) {
        const std::wstring line = variable;
        const std::size_t equal = line.find(L'=', 1);  // a drive's folder has a name that begins with it
        if (equal != line.npos) variables[line.substr(0, equal)] = line.substr(equal + 1);
    }
    for (const auto& [name, value] : program.environment) variables[wide(name)] = wide(value);
    std::wstring result;
    for (const auto& [name, value] : variables) (result += name + L'=' + value) += L'\0';
    return result += L'\0';
}

struct Closer {
    using pointer = HANDLE;
    void operator()(HANDLE handle) const {
        if (handle && handle != INVALID_HANDLE_VALUE) CloseHandle(handle);
    }
};
using Handle = std::unique_ptr<HANDLE, Closer>;

// Opens a file that takes everything and keeps nothing; children inherit it.
Handle null_file() {
    SECURITY_ATTRIBUTES inherited{sizeof inherited, nullptr, TRUE};
    return Handle(
        CreateFileW(L"NUL", GENERIC_WRITE, FILE_SHARE_READ | FILE_SHARE_WRITE, &inherited, OPEN_EXISTING, 0, nullptr));
}

std::string words_of_exception(DWORD code) {
    switch (code) {
        case EXCEPTION_ACCESS_VIOLATION: return "access violation";
        case EXCEPTION_ILLEGAL_INSTRUCTION: return "illegal instruction";
        case EXCEPTION_INT_DIVIDE_BY_ZERO: return "integer division by zero";
        case EXCEPTION_STACK_OVERFLOW: return "stack overflow";
        case static_cast<DWORD>(STATUS_CONTROL_C_EXIT): return "interrupt";
        default: return text("exception 0x", std::hex, code);
    }
}

// Returns nothing if the variable does not exist or is empty.
std::optional<std::wstring> variable(const wchar_t* name) {
    std::wstring value(GetEnvironmentVariableW(name, nullptr, 0), 0);
    value.resize(GetEnvironmentVariableW(name, value.data(), static_cast<DWORD>(value.size())));
    if (value.empty()) return std::nullopt;
    return value;
}

double seconds_of(FILETIME time) {
    return 1e-7 * static_cast<double>(std::uint64_t{time.dwHighDateTime} << 32 | time.dwLowDateTime);
}

// Makes the console understand escape sequences. Returns false if it does not, or if the output is none.
bool takes_escapes(HANDLE output) {
    DWORD mode = 0;
    return GetConsoleMode(output, &mode) && SetConsoleMode(output, mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING);
}

// Windows counts the calls.
bool has_sockets() {
    WSADATA data;
    static const bool is_started = WSAStartup(MAKEWORD(2, 2), &data) == 0;
    return is_started;
}

}  // namespace

const SystemLibrary vulkan_loader = {"vulkan-1.dll", "the driver of a GPU brings it"};
const SystemLibrary image_denoiser = {"OpenImageDenoise.dll",
                                      "the package pyoidn of PyPI has it; PATH must name its folder pyoidn\\oidn\\bin"};

void* open_library(const char* name) noexcept { return LoadLibraryW(wide(name).c_str()); }
void close_library(void* library) noexcept { FreeLibrary(static_cast<HMODULE>(library)); }
void* symbol_of(void* library, const char* name) noexcept {
    return reinterpret_cast<void*>(GetProcAddress(static_cast<HMODULE>(library), name));
}

int process_id() noexcept { return static_cast<int>(GetCurrentProcessId()); }

fs::path this_program() {
    std::wstring name(MAX_PATH, 0);
    for (;;) {
        const DWORD length = GetModuleFileNameW(nullptr, name.data(), static_cast<DWORD>(name.size()));
        if (length < name.size()) return name.substr(0, length);
        name.resize(2 * name.size());
    }
}

std::optional<ProgramEnd> run_program(const Program& program) {
    std::wstring line = command_line(program), environment = environment_of(program);
    STARTUPINFOW start{};
    start.cb = sizeof start;
    const Handle nothing = program.is_silent ? null_file() : Handle();
    if (program.is_silent) {
        start.dwFlags = STARTF_USESTDHANDLES;
        start.hStdInput = GetStdHandle(STD_INPUT_HANDLE);
        start.hStdOutput = start.hStdError = nothing.get();
    }
    PROCESS_INFORMATION made{};
    if (!CreateProcessW(nullptr, line.data(), nullptr, nullptr, TRUE, CREATE_UNICODE_ENVIRONMENT, environment.data(),
                        nullptr, &start, &made))
        return std::nullopt;
    const Handle process(made.hProcess), thread(made.hThread);
    DWORD status = 0;
    if (WaitForSingleObject(made.hProcess, INFINITE) != WAIT_OBJECT_0 || !GetExitCodeProcess(made.hProcess, &status))
        return std::nullopt;
    constexpr DWORD first_exception = 0xC0000000;
    if (status >= first_exception) return ProgramEnd{static_cast<int>(status), words_of_exception(status)};
    return ProgramEnd{static_cast<int>(status)};
}

void become_program(const Program& program) {
    if (const std::optional<ProgramEnd> end = run_program(program)) std::exit(end->status);
}

std::vector<std::string> arguments_of(int count, char**) {
    SetConsoleOutputCP(CP_UTF8);
    _fmode = _O_BINARY;
    for (std::FILE* const output : {stdout, stderr}) _setmode(_fileno(output), _O_BINARY);
    int all = 0;
    const std::unique_ptr<LPWSTR, decltype(&LocalFree)> words(CommandLineToArgvW(GetCommandLineW(), &all), &LocalFree);
    std::vector<std::string> arguments;
    for (int i = all - count + 1; i < all; ++i) arguments.push_back(narrow(words.get()[i]));
    return arguments;
}

fs::path cache_folder() {
    const fs::path folder = state_folder();
    return folder.empty() ? folder : folder / "cache";
}

fs::path state_folder() {
    const auto folder = variable(L"LOCALAPPDATA");
    return folder ? fs::path(*folder) / "twinray" : fs::path();
}

// Folders below the user's own temporary one are private.
fs::path make_temporary_folder() {
    std::random_device random;
    const fs::path folder = fs::temp_directory_path() / text("twinray-", std::hex, random(), random());
    std::error_code error;
    if (!fs::create_directory(folder, error))
        fail(folder.string(), ": no folder for temporary files; TEMP has to name one to write to");
    return folder;
}

std::size_t terminal_width() noexcept {
    CONSOLE_SCREEN_BUFFER_INFO info{};
    if (!GetConsoleScreenBufferInfo(GetStdHandle(STD_OUTPUT_HANDLE), &info)) return 0;
    return static_cast<std::size_t>(std::max(0, info.srWindow.Right - info.srWindow.Left + 1));
}

bool is_error_terminal() noexcept { return takes_escapes(GetStdHandle(STD_ERROR_HANDLE)); }

bool is_mapped(std::uint64_t address) noexcept {
    MEMORY_BASIC_INFORMATION info{};
    return VirtualQuery(reinterpret_cast<const void*>(address), &info, sizeof info) != 0 && info.State == MEM_COMMIT;
}

const SharedMemory shared_memory{VK_KHR_EXTERNAL_MEMORY_WIN32_EXTENSION_NAME, "vkGetMemoryWin32HandleKHR",
                                 VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_WIN32_BIT, false};

std::intptr_t copy_handle(std::intptr_t handle) noexcept {
    HANDLE copy = nullptr;
    const HANDLE self = GetCurrentProcess();
    return DuplicateHandle(self, reinterpret_cast<HANDLE>(handle), self, &copy, 0, FALSE, DUPLICATE_SAME_ACCESS)
               ? reinterpret_cast<std::intptr_t>(copy)
               : no_handle;
}
void close_handle(std::intptr_t handle) noexcept { CloseHandle(reinterpret_cast<HANDLE>(handle)); }

VkResult export_memory(PFN_vkVoidFunction get_handle, VkDevice device, VkDeviceMemory memory, std::intptr_t& handle) {
    VkMemoryGetWin32HandleInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_MEMORY_GET_WIN32_HANDLE_INFO_KHR;
    info.memory = memory;
    info.handleType = shared_memory.type;
    HANDLE made = nullptr;
    const VkResult result = reinterpret_cast<PFN_vkGetMemoryWin32HandleKHR>(get_handle)(device, &info, &made);
    handle = reinterpret_cast<std::intptr_t>(made);
    return result;
}

VkResult import_memory(PFN_vkAllocateMemory allocate, VkDevice device, VkMemoryAllocateInfo info, std::intptr_t handle,
                       VkDeviceMemory& memory) {
    VkImportMemoryWin32HandleInfoKHR import{};
    import.sType = VK_STRUCTURE_TYPE_IMPORT_MEMORY_WIN32_HANDLE_INFO_KHR;
    import.pNext = info.pNext;
    import.handleType = shared_memory.type;
    import.handle = reinterpret_cast<HANDLE>(handle);
    info.pNext = &import;
    return allocate(device, &info, nullptr, &memory);
}

std::optional<ProcessorSeconds> processor_seconds() {
    FILETIME idle, kernel, user, started, ended, own_kernel, own_user;
    if (!GetSystemTimes(&idle, &kernel, &user) ||
        !GetProcessTimes(GetCurrentProcess(), &started, &ended, &own_kernel, &own_user))
        return std::nullopt;
    const double all = seconds_of(kernel) + seconds_of(user);  // the kernel's have the idle ones among them
    return ProcessorSeconds{all, all - seconds_of(idle), seconds_of(own_kernel) + seconds_of(own_user)};
}

std::optional<Connection> Connection::open(const std::string& host, const std::string& port, int patience_seconds) {
    addrinfo hints{}, *found = nullptr;
    hints.ai_socktype = SOCK_STREAM;
    if (!has_sockets() || getaddrinfo(host.c_str(), port.c_str(), &hints, &found) != 0) return std::nullopt;
    const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> all(found, &freeaddrinfo);
    for (const addrinfo* one = all.get(); one; one = one->ai_next) {
        const SOCKET made = socket(one->ai_family, one->ai_socktype, one->ai_protocol);
        if (made == INVALID_SOCKET) continue;
        Connection connection(static_cast<std::intptr_t>(made));
        const DWORD patience = static_cast<DWORD>(patience_seconds) * 1000;
        setsockopt(made, SOL_SOCKET, SO_SNDTIMEO, reinterpret_cast<const char*>(&patience), sizeof patience);
        if (connect(made, one->ai_addr, static_cast<int>(one->ai_addrlen)) == 0) return connection;
    }
    return std::nullopt;
}

Connection::~Connection() {
    if (socket_ != none) closesocket(static_cast<SOCKET>(socket_));
}

bool Connection::send(std::string_view bytes) noexcept {
    for (std::size_t sent = 0; sent < bytes.size();) {
        const int most = static_cast<int>(std::min<std::size_t>(bytes.size() - sent, 1 << 30));
        const int count = ::send(static_cast<SOCKET>(socket_), bytes.data() + sent, most, 0);
        if (count <= 0) return false;
        sent += static_cast<std::size_t>(count);
    }
    return true;
}

}  // namespace twinray::platform
