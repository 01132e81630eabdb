// SPDX-License-Identifier: MIT
// The arguments of shaders/verify/copy_items.comp.
#ifndef TWINRAY_VERIFY_COPY_ITEMS_H
#define TWINRAY_VERIFY_COPY_ITEMS_H

struct CopyItemsArgs
{
    Uints from;
    Uints to;
    uint count;
    uint words_per_item;
};
#endif
