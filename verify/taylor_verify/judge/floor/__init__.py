"""The roundoff floor, the error that perfect rounding would leave, and the data it depends on."""
