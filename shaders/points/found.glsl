// SPDX-License-Identifier: MIT
// Appends an item found by a search by radius.
void append(PointSearchArgs args, uint point, uint item, double distance)
{
    uint slot = append_to(args.total);
    if (slot >= args.capacity) return;
    AT(args.found, slot).point = point;
    AT(args.found, slot).item = item;
    AT(args.found, slot).distance = distance;
}
