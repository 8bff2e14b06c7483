% SF_INVERSE_MKP  Invert a hysteresis model exactly: wanted displacement to temperature, say.
%
%   X = SF_INVERSE_MKP(FILE, Y) reads the model file FILE and gives the inputs X that make the
%   outputs Y, sample by sample. All operators start off. X has the shape of Y.
%
%   [X, STATUS] = ... also says where Y can be reached (int8): 0 within reach, -1 below and 1 above
%   every output of the model.
%
%   X = SF_INVERSE_MKP(..., NAME, VALUE, ...) with the options
%       'policy'     'hold' (the default): the input rests while the target rests;
%                    'anticipate': the input crosses the dead band at once, to where the output
%                    starts to move the way that the target goes next. That way is looked up in Y;
%                    a block that gets one sample at a time needs 'heading'
%       'heading'    the way that the target goes next: 1 rises, -1 falls, 0 hold; one number for
%                    each target, or one for all
%       'tolerance'  reversals of Y up to this size are noise and not followed, in the output's
%                    unit; by default 0, with 'anticipate' 1 % of the model's range
%       'load'       the load, of a model that depends on one
%
%   B = SF_INVERSE_MKP('open', FILE) opens a block that remembers. X = SF_INVERSE_MKP(B, Y, ...)
%   goes on from its last state. 'reset', 'save', 'restore', 'info' and 'close' are those of SF_MKP;
%   each function has blocks of its own.
%
%   A model with a weight below zero has no inverse: hysteron:negativeWeights.
%
%   Example
%       Y = 5 + 3 * sin((0:200) / 20);
%       T = sf_Inverse_MKP('spring.json', Y, 'policy', 'anticipate');
%       max(abs(sf_MKP('spring.json', T) - Y))
%
%   See also SF_MKP.
function varargout = sf_Inverse_MKP(varargin)
error('hysteron:notBuilt', ...
    'sf_Inverse_MKP is not built yet: run octave/build in a shell, or build_hysteron here');
end
