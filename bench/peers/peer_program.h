// Programs of peers read files in the working directory for python_rays.py, and write one and a line of seconds.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#ifdef __CUDACC__
#include <cuda_runtime.h>
#endif

namespace peer {

// T has no padding: float, int, or arrays of them.
template <class T>
std::vector<T> read(const char* file) {
    std::ifstream in(file, std::ios::binary | std::ios::ate);
    if (!in) throw std::runtime_error(std::string("no file ") + file);
    std::vector<T> items(static_cast<std::size_t>(in.tellg()) / sizeof(T));
    in.seekg(0);
    in.read(reinterpret_cast<char*>(items.data()), static_cast<std::streamsize>(items.size() * sizeof(T)));
    return items;
}

inline void write_distances(const std::vector<float>& distances) {
    std::ofstream("distances", std::ios::binary)
        .write(reinterpret_cast<const char*>(distances.data()),
               static_cast<std::streamsize>(distances.size() * sizeof(float)));
}

struct Ray {
    float origin[3], direction[3];
};

// Calls the work once to warm up, and then as often again; prints the median of the seconds.
template <class Work>
void time(const Work& work, int rounds = 5) {
    std::vector<double> seconds;
    for (int i = 0; i <= rounds; ++i) {
        const auto start = std::chrono::steady_clock::now();
        work();
        seconds.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    std::sort(seconds.begin() + 1, seconds.end());
    std::printf("%.9f\n", seconds[1 + static_cast<std::size_t>(rounds) / 2]);
}

#ifdef __CUDACC__
inline void check(cudaError_t error) {
    if (error != cudaSuccess) throw std::runtime_error(cudaGetErrorString(error));
}

// Allocates on the device. The memory is never freed, since the program ends.
template <class T>
T* device_array(std::size_t count) {
    T* items = nullptr;
    check(cudaMalloc(&items, count * sizeof(T)));
    return items;
}
template <class T>
T* on_device(const std::vector<T>& items) {
    T* const copy = device_array<T>(items.size());
    check(cudaMemcpy(copy, items.data(), items.size() * sizeof(T), cudaMemcpyHostToDevice));
    return copy;
}
template <class T>
std::vector<T> on_host(const T* items, std::size_t count) {
    std::vector<T> copy(count);
    check(cudaMemcpy(copy.data(), items, count * sizeof(T), cudaMemcpyDeviceToHost));
    return copy;
}
#endif

}  // namespace peer
