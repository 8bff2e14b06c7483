% SF_MKP  Simulate a hysteresis model: temperature to displacement, say.
%
%   Y = SF_MKP(FILE, X) reads the model file FILE and gives the outputs Y for the inputs X, sample
%   by sample, from where the model starts: the state that its fit found before the first sample, or
%   every operator off. Y has the shape of X. [Y, CLIPPED] = ... also says where an input of the
%   operators lay outside the model's range: -1 below, 1 above, 0 inside (int8).
%
%   Y = SF_MKP(..., NAME, VALUE, ...) with the options
%       'time'       the time of each sample in seconds, not going back, of a model with a thermal
%                    body, creep, lag or ring. An input is the one held since the sample before
%       'load'       the load of each sample, or one for all, of a model that depends on one
%       'start'      'fitted' (the default), 'off' or 'on': where a FILE starts
%
%   B = SF_MKP('open', FILE) opens a block that remembers, also with 'start'; with 'load', L it is
%   the model at the load L, which needs no load any more. Then
%       Y = SF_MKP(B, X, ...)      goes on from where the block stands, with one sample or many;
%                                  time counts from the last sample
%       SF_MKP('reset', B)         every operator off; SF_MKP('reset', B, 'on'): every operator on;
%                                  SF_MKP('reset', B, 'fitted'): where the model starts
%       S = SF_MKP('save', B)      what the block remembers: a struct of turning_points, input,
%                                  stages and time
%       SF_MKP('restore', B, S)    puts it back, bit for bit
%       I = SF_MKP('info', B)      what the model is, and what it needs; also of a FILE
%       T = SF_MKP('temperature', B)   the temperature after the last sample
%       SF_MKP('close', B)         frees the block; `clear sf_MKP` frees them all
%
%   Units are those of the model; info tells them. X is real and finite, of any numeric type. Errors
%   have the identifiers hysteron:argument, notFinite, block, file, modelFile, load, thermal,
%   turningPoints; `thermal` is a time that is missing or goes back. After one the block stands
%   where it stood.
%
%   Example
%       T = [20:80, 80:-1:30];
%       plot(T, sf_MKP('spring.json', T))
%
%   See also SF_INVERSE_MKP.
function varargout = sf_MKP(varargin)
error('hysteron:notBuilt', ...
    'sf_MKP is not built yet: run octave/build in a shell, or build_hysteron here');
end
