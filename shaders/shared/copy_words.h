// SPDX-License-Identifier: MIT
// What shaders/engine/copy_words.comp takes.
#ifndef TWINRAY_SHARED_COPY_WORDS_H
#define TWINRAY_SHARED_COPY_WORDS_H

struct CopyWordsArgs
{
    Uints from;
    Uints to;
    uint count;
    uint reserved;
};
#endif
