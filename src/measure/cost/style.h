// How the report looks: its style sheets. Light and dark after the reader's settings; no fonts but the reader's own.
#ifndef MEASURE_COST_STYLE_H
#define MEASURE_COST_STYLE_H

extern const char chart_style[]; // the colours, and a chart
extern const char cost_style[];  // the page, in those colours

#endif
