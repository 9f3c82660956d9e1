// Holds nothing: the headers that the test programs share are compiled with this file.
