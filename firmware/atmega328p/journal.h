/* The journal in EEPROM. */
#ifndef JOURNAL_H
#define JOURNAL_H

#include "hardware.h"

void journal_load(record *last);
bool journal_store(const record *next);

#endif
