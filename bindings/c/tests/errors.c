/* An error of one clip does not hide the rest of a bank, of a rig's joints or of its scalars.
 *
 *     errors BANK.ptb SCALARS.ptn */
#include <stdio.h>
#include <stdlib.h>

#include "file.h"
#include "pantin.h"

static void check(int held, const char *what) {
    if (!held) {
        printf("failed: %s\n", what);
        exit(1);
    }
}

int main(int argc, char **argv) {
    uint32_t length, count = 0, refused = 0;
    pantin_source source;
    pantin_bank bank;
    pantin_entry entry;
    pantin_clip clip;
    pantin_joint joint;
    pantin_scalar scalar;
    uint8_t *bytes;
    if (argc < 3) return 2;
    bytes = file(argv[1], &length);
    pantin_memory(&source, bytes, length);
    check(pantin_open_bank(&bank, &source) == PANTIN_OK, "bank");
    pantin_first_entry(&entry, &bank);
    check(pantin_next_entry(&entry) == 1, "the first clip");
    bytes[entry.start + entry.length / 2] ^= 1;
    pantin_first_entry(&entry, &bank);
    while (pantin_next_entry(&entry)) {
        count++;
        refused += pantin_open_entry(&clip, &entry) != PANTIN_OK;
    }
    check(count == bank.clips && count > 1, "every clip of the bank is listed");
    check(refused == 1, "one clip is damaged");
    source.error = PANTIN_ERROR_CRC;
    pantin_first_joint(&joint, &bank.rig);
    for (count = 0; pantin_next_joint(&joint); count++) {}
    check(count == bank.rig.joints && count > 0, "every joint is listed after an error");
    free(bytes);
    bytes = file(argv[2], &length);
    pantin_memory(&source, bytes, length);
    check(pantin_open(&clip, &source, NULL) == PANTIN_OK, "clip");
    source.error = PANTIN_ERROR_CRC;
    pantin_first_scalar(&scalar, &clip.rig);
    for (count = 0; pantin_next_scalar(&scalar); count++) {}
    check(count == clip.rig.scalars && count > 0, "every scalar is listed after an error");
    free(bytes);
    return 0;
}
