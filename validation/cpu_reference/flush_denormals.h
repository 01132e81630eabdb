// Denormal numbers, as treated by devices that flush them.
#pragma once

namespace twinray {

// While it lives, this thread's arithmetic reads denormals as 0 and gives 0 in their place.
class FlushDenormals {
  public:
    FlushDenormals();
    ~FlushDenormals();
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

    static bool is_able();  // whether this processor can, as far as this build knows

  private:
    unsigned long saved_ = 0;
};

}  // namespace twinray
