// How the report looks: its style sheet. Light and dark after the reader's settings; no fonts but the reader's own.
#ifndef MEASURE_COST_STYLE_H
#define MEASURE_COST_STYLE_H

extern const char cost_style[];

#endif
