% SF_MKP  Simulate a hysteresis model: temperature to displacement, say.
%
%   Y = SF_MKP(FILE, X) reads the model file FILE and gives the outputs Y for the inputs X, sample
%   by sample, from every operator off. Y has the shape of X. [Y, CLIPPED] = ... also says where an
%   input lay outside the model's range: -1 below, 1 above, 0 inside (int8).
%
%   Y = SF_MKP(FILE, X, 'load', L) takes a model that depends on a load at the load L.
%
%   B = SF_MKP('open', FILE) opens a block that remembers, also with 'load', L. Then
%       Y = SF_MKP(B, X)           goes on from where the block stands, with one sample or many
%       SF_MKP('reset', B)         every operator off; SF_MKP('reset', B, 'on'): every operator on
%       S = SF_MKP('save', B)      what the block remembers: a struct of turning_points and input
%       SF_MKP('restore', B, S)    puts it back, bit for bit
%       I = SF_MKP('info', B)      what the model is; also of a FILE
%       SF_MKP('close', B)         frees the block; `clear sf_MKP` frees them all
%
%   Units are those of the model; info tells them. X is real and finite, of any numeric type. Errors
%   have the identifiers hysteron:argument, notFinite, block, file, modelFile, load, thermal,
%   turningPoints.
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
